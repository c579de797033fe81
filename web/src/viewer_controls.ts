// The viewer with its toolbar, legend and readout of pixel values.
import {html, scrolling, section, select} from "./dom";
import {number_text} from "./format";
import {Images} from "./pixels";
import type {PageData} from "./results";
import {error_metrics} from "./tone";
import {Viewer} from "./viewer";
import {listen_to_keys, listen_to_pointers} from "./viewer_input";

// The key that shows the image at this place of the list.
const key_text = (place: number): string => (place < 10 ? String(place) : place < 20 ? `⇧${place - 10}` : "");

function slider(label: string, min: number, max: number, step: number, value: number, change: (value: number) => void) {
    const input = html("input", {type: "range", min, max, step, value}), output = html("output");
    input.addEventListener("input", () => change(input.valueAsNumber));
    return {input, output, field: html("label", {class: "field"}, html("span", {}, label), input, output)};
}

function button(text: string, label: string, action: () => void): HTMLButtonElement {
    const element = html("button", {type: "button", "aria-label": label, title: label}, text);
    element.addEventListener("click", action);
    return element;
}

function table_line(name: string, ...values: string[]): string {
    return name.slice(0, 24).padEnd(24) + values.map((value) => value.padStart(11)).join("");
}

function draw_legend(canvas: HTMLCanvasElement, map: [number, number, number][]): void {
    canvas.width = map.length;
    canvas.height = 1;
    const image = new ImageData(map.length, 1);
    map.forEach((colour, i) => image.data.set([...colour, 255], 4 * i));
    canvas.getContext("2d")!.putImageData(image, 0, 0);
}

export function viewer_section(data: PageData): HTMLElement | null {
    const {images, colour_map} = data, first = images[0];
    if (!first) return null;
    const reference = images.findIndex((image) => image.name === "reference");
    // Place 0, and key 0, is the reference's; without one it stays empty.
    const order = [...(reference < 0 ? [] : [reference]), ...images.keys()].filter((v, i, all) => all.indexOf(v) === i);
    const keys = reference < 0 ? [NaN, ...order] : order;
    const canvas = html("canvas", {id: "viewer", tabindex: 0, role: "img",
                                   style: `--width:${first.width};--height:${first.height}`});
    const message = html("p", {class: "message", role: "status"});
    const viewer: Viewer = new Viewer(canvas, Images.of(data), reference, colour_map, () => refresh(),
                                      (text) => { message.textContent = text; });
    const {state, view} = viewer;

    const radios = order.map((index) => {
        const radio = html("input", {type: "radio", name: "shown", value: index, class: "hidden"});
        radio.addEventListener("change", () => viewer.update({shown: index}));
        return {index, radio, label: html("label", {class: "choice"}, radio,
            html("span", {}, html("kbd", {"aria-hidden": "true"}, key_text(keys.indexOf(index))), images[index]!.name))};
    });
    const modes = select("Show", [["image", "Image"], ...(reference < 0 ? [] : Object.entries(error_metrics)
        .map(([key, metric]): [string, string] => [key, metric.name]))], "image", (mode) => viewer.update({mode}));
    const exposure = slider("Exposure", -12, 12, 0.25, 0, (value) => viewer.update({exposure: value}));
    const maximum = slider("Maximum", -6, 4, 0.05, 0, (value) => viewer.update({maximum: 10 ** value}));
    const toggle_split = (): void => viewer.update({split: !state.split});
    const split_box = html("input", {type: "checkbox"});
    split_box.addEventListener("change", toggle_split);
    const other = select("with", order.map((i) => [String(i), images[i]!.name]), String(state.other),
                         (index) => viewer.update({other: Number(index)}));
    const divider = slider("Divider", 0, 100, 0.5, 50, (value) => viewer.update({divider: value / 100}));
    const zoomed = (action: () => void) => () => { action(); viewer.redraw(); };
    const zoom_text = html("output", {"aria-label": "Zoom"});
    const ramp = html("canvas", {"aria-hidden": "true"});
    draw_legend(ramp, colour_map);
    const legend_high = html("span"), legend_formula = html("span", {class: "formula"});
    const legend = html("div", {class: "legend", id: "legend", role: "group", "aria-label": "Colours of the error"},
                        html("span", {}, "0"), ramp, legend_high, legend_formula);
    const readout = html("pre", {class: "readout", id: "readout", "aria-label": "Pixel values"});

    function value_line(index: number): string {
        const pixels = viewer.pixels(index), [x, y] = state.pixel!;
        if (!pixels) return "";
        const pixel = y * pixels.width + x, error = viewer.pixel_errors(index)?.[pixel];
        const values = [0, 1, 2].map((channel) => number_text(pixels.value(channel, pixel), 4));
        return table_line(images[index]!.name, ...values, error === undefined ? "" : number_text(error, 4));
    }

    function refresh(): void {
        const is_image = state.mode === "image", seen = images[state.shown]!.name;
        for (const {index, radio} of radios) radio.checked = index === state.shown;
        modes.querySelector("select")!.value = state.mode;
        exposure.field.hidden = !is_image;
        exposure.input.valueAsNumber = state.exposure;
        exposure.output.textContent = `${state.exposure > 0 ? "+" : ""}${state.exposure} EV`.replace("-", "−");
        maximum.field.hidden = legend.hidden = is_image;
        if (!is_image && !Number.isNaN(state.maximum)) {
            maximum.input.valueAsNumber = Math.log10(state.maximum);
            maximum.output.textContent = legend_high.textContent = number_text(state.maximum);
            legend_formula.textContent = `${error_metrics[state.mode]!.formula}, mean of the channels; brighter: ≥ maximum`;
        }
        split_box.checked = state.split;
        other.hidden = divider.field.hidden = !state.split;
        divider.input.valueAsNumber = 100 * state.divider;
        divider.output.textContent = `${Math.round(100 * state.divider)} %`;
        zoom_text.textContent = `${Math.round(100 * view.zoom)} %`;
        canvas.style.touchAction = view.fitted && !state.split ? "pan-y" : "none";
        canvas.setAttribute("aria-label", `${is_image ? "Rendered image" : error_metrics[state.mode]!.name} of ${seen}` +
            (state.split ? `, split with ${images[state.other]!.name}` : ""));
        Object.assign(canvas.dataset, {shown: seen, mode: state.mode, zoom: view.zoom.toFixed(4), x: view.x.toFixed(4),
                                       y: view.y.toFixed(4), split: state.split ? state.divider.toFixed(3) : "off",
                                       ready: String(viewer.seen().every((i) => viewer.images.get(i)))});
        const indices = [...new Set([...viewer.seen(), ...(reference < 0 ? [] : [reference])])];
        readout.textContent = state.pixel
            ? [table_line(`x ${state.pixel[0]}, y ${state.pixel[1]}`, "R", "G", "B", is_image ? "" : "error"),
               ...indices.map(value_line)].join("\n")
            : "Point at the image to read its linear values.";
    }

    listen_to_pointers(viewer);
    listen_to_keys(viewer, keys, toggle_split);
    return section("images", "Images",
        html("fieldset", {class: "choices"}, html("legend", {class: "hidden"}, "Image shown"), ...radios.map((r) => r.label)),
        html("div", {class: "toolbar"}, modes, exposure.field, maximum.field,
             html("label", {class: "field"}, split_box, html("span", {}, "Split")), other, divider.field,
             html("span", {class: "zoom"}, button("−", "Zoom out", zoomed(() => view.zoom_by(Math.SQRT1_2))), zoom_text,
                  button("+", "Zoom in", zoomed(() => view.zoom_by(Math.SQRT2))),
                  button("1:1", "One image pixel per screen pixel", zoomed(() => view.zoom_by(1 / view.zoom))),
                  button("Fit", "Fit the whole image", zoomed(() => view.fit())))),
        canvas, message, legend, scrolling("Pixel values under the cursor", readout),
        html("details", {}, html("summary", {}, "Keys"), html("p", {class: "note"},
            "0 reference · 1–9 entries, with Shift 10–19 · [ ] previous, next · + − f zoom in, out, fit · s split · " +
            "e E exposure up, down · arrows pan when the image has the focus. Wheel or pinch zooms, dragging pans.")));
}
