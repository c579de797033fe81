// A plot with its choices, its legend and its numbers as a table.
import {html, scrolling, svg} from "./dom";
import {interval_text, number_text} from "./format";
import {marker, plot, type PlotOptions, type Series} from "./plot";

export interface Content extends PlotOptions {
    series: Series[];
}

function swatch(colour: number): SVGSVGElement {
    return svg("svg", {width: 22, height: 12, viewBox: "0 0 22 12", class: "swatch series", "aria-hidden": "true",
                       style: `--colour:var(--c${colour % 12})`},
               svg("path", {d: "M0 6H22", class: "line"}), marker(colour, 11, 6));
}

function number_table({series, x_label, y_label}: Content): HTMLTableElement {
    const rows = series.flatMap(({name, points}) => points.map(({x, y}) => html("tr", {},
        html("th", {scope: "row"}, name), html("td", {}, number_text(x)), html("td", {}, number_text(y.mean)),
        html("td", {}, interval_text(y)))));
    return html("table", {}, html("thead", {}, html("tr", {}, ...["Entry", x_label, y_label, "95% interval"].map((text) =>
        html("th", {scope: "col"}, text)))), html("tbody", {}, ...rows));
}

// `content` is asked again by `redraw`, which the caller calls when a choice has changed.
export function figure(id: string, choices: HTMLElement[], content: () => Content) {
    const drawing = html("div", {class: "plot"}), legend = html("div", {class: "series-list"}), numbers = html("div");
    const hidden = new Set<string>();
    const draw = (): void => {
        const shown = content(), width = Math.max(drawing.clientWidth, 280);
        const series = shown.series.filter(({name}) => !hidden.has(name));
        drawing.replaceChildren(plot(series, width, Math.round(Math.min(460, Math.max(280, width * 0.5))), shown)
                                ?? html("p", {class: "note"}, "No number above zero to draw."));
        numbers.replaceChildren(scrolling(`${shown.y_label} as a table`, number_table({...shown, series})));
    };
    const redraw = (): void => {
        legend.replaceChildren(...content().series.map(({name, colour}) => {
            const box = html("input", {type: "checkbox", checked: !hidden.has(name)});
            box.addEventListener("change", () => {
                if (box.checked) hidden.delete(name);
                else hidden.add(name);
                draw();
            });
            return html("label", {}, box, swatch(colour), html("span", {}, name));
        }));
        draw();
    };
    new ResizeObserver(draw).observe(drawing);
    const element = html("figure", {id}, html("div", {class: "toolbar"}, ...choices), drawing, legend,
                         html("details", {}, html("summary", {}, "Numbers of this plot"), numbers));
    redraw();
    return {element, redraw};
}
