// Building elements. Text is always set as text, so names cannot become markup.

type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | undefined>;

function fill(element: Element, attributes: Attributes, children: Child[]): void {
    for (const [name, value] of Object.entries(attributes))
        if (value !== undefined && value !== false) element.setAttribute(name, value === true ? "" : String(value));
    element.append(...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false));
}

export function html<K extends keyof HTMLElementTagNameMap>(
    tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
    const element = document.createElement(tag);
    fill(element, attributes, children);
    return element;
}

export function svg<K extends keyof SVGElementTagNameMap>(
    tag: K, attributes: Attributes = {}, ...children: Child[]): SVGElementTagNameMap[K] {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    fill(element, attributes, children);
    return element;
}

// A labelled list of choices; `change` gets the chosen key.
export function select(label: string, choices: [string, string][], chosen: string, change: (key: string) => void): HTMLLabelElement {
    const list = html("select", {}, ...choices.map(([key, text]) => html("option", {value: key, selected: key === chosen}, text)));
    list.addEventListener("change", () => change(list.value));
    return html("label", {class: "field"}, html("span", {}, label), list);
}

// A part of the page with a heading that names it.
export function section(id: string, title: string, ...children: Child[]): HTMLElement {
    return html("section", {id, "aria-labelledby": `${id}-title`}, html("h2", {id: `${id}-title`}, title), ...children);
}

// What is wider than the page scrolls by itself, with the keyboard too.
export function scrolling(label: string, child: Node): HTMLElement {
    return html("div", {class: "scrolling", role: "region", tabindex: 0, "aria-label": label}, child);
}
