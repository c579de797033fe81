// A plot of estimates with error bars, as SVG. Axes are logarithmic where asked for.
import {scaleLinear, scaleLog} from "d3-scale";
import {svg} from "./dom";
import {estimate_text, number_text, power_of_ten} from "./format";
import {is_number, type Estimate} from "./results";

export interface Series {
    name: string;
    colour: number;  // index of the palette
    points: {x: number; y: Estimate; label?: string}[];
}

export interface PlotOptions {
    x_label: string;
    y_label: string;
    log_x: boolean;
    joined?: boolean;  // by a line, unless false
    level?: {y: number; label: string} | undefined;  // a horizontal line
}

const margin = {top: 14, right: 16, bottom: 44, left: 58};
type Scale = ReturnType<typeof scaleLinear<number, number>> | ReturnType<typeof scaleLog<number, number>>;

function axis_scale(values: number[], range: [number, number], log: boolean): Scale {
    let low = Math.min(...values), high = Math.max(...values);
    if (log) {
        const pad = Math.max((high / low) ** 0.05, 1.08);
        return scaleLog([low / pad, high * pad], range);
    }
    const pad = 0.05 * (high - low || 1);
    return scaleLinear([low - pad, high + pad], range);
}

// Labelled ticks: powers of ten over some decades, 1-2-5 within a few, else what the scale finds.
function labelled_ticks(scale: Scale, log: boolean, room: number): number[] {
    const [low, high] = scale.domain() as [number, number];
    if (!log) return scale.ticks(Math.max(3, Math.round(room / 90)));
    const decades = Math.log10(high / low), candidates: number[] = [];
    const steps = decades > 2.5 ? [1] : decades > 0.8 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9];
    for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e)
        candidates.push(...steps.map((step) => Number(`${step}e${e}`)));
    const ticks = candidates.filter((tick) => tick >= low && tick <= high);
    const every = Math.ceil(ticks.length / Math.max(2, room / 44));
    return ticks.filter((_, i) => i % every === 0);
}

const tick_text = (tick: number): string => {
    const exponent = Math.log10(Math.abs(tick));
    return Number.isInteger(exponent) && Math.abs(exponent) > 2 ? power_of_ten(exponent)
        : String(Number(tick.toPrecision(3))).replace("-", "−");
};

// A shape for each series, so that they differ not by colour alone.
const markers = ["M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0", "M-3.5-3.5h7v7h-7z", "M0-4.8L4.6 3.4H-4.6z", "M0-5L5 0L0 5L-5 0z",
                 "M0 4.8L4.6-3.4H-4.6z", "M-1.3-4.5h2.6v3.2h3.2v2.6h-3.2v3.2h-2.6v-3.2h-3.2v-2.6h3.2z"];

export function marker(colour: number, x: number, y: number): SVGPathElement {
    return svg("path", {d: markers[colour % markers.length]!, transform: `translate(${x} ${y})`, class: "marker"});
}

function draw_axes(x: Scale, y: Scale, width: number, height: number, options: PlotOptions): SVGGElement {
    const g = svg("g", {class: "axes"}), right = width - margin.right, bottom = height - margin.bottom;
    for (const tick of labelled_ticks(x, options.log_x, right - margin.left)) {
        const at = x(tick);
        g.append(svg("path", {d: `M${at} ${margin.top}V${bottom}`, class: "grid"}),
                 svg("text", {x: at, y: bottom + 18, "text-anchor": "middle"}, tick_text(tick)));
    }
    for (const tick of labelled_ticks(y, true, bottom - margin.top)) {
        const at = y(tick);
        g.append(svg("path", {d: `M${margin.left} ${at}H${right}`, class: "grid"}),
                 svg("text", {x: margin.left - 8, y: at + 4, "text-anchor": "end"}, tick_text(tick)));
    }
    g.append(svg("path", {d: `M${margin.left} ${margin.top}V${bottom}H${right}`, class: "frame"}),
             svg("text", {x: (margin.left + right) / 2, y: height - 6, "text-anchor": "middle", class: "label"}, options.x_label),
             svg("text", {transform: `translate(13 ${(margin.top + bottom) / 2}) rotate(-90)`, "text-anchor": "middle",
                          class: "label"}, options.y_label));
    return g;
}

// A point whose estimate is not positive has no place on a logarithmic axis: only the part of its interval that has.
function draw_series(series: Series, x: Scale, y: Scale, bottom: number, joined: boolean): SVGGElement {
    const g = svg("g", {class: "series", style: `--colour:var(--c${series.colour % 12})`});
    const placed = series.points.filter((point) => is_number(point.y.mean) && point.y.mean > 0);
    const line = placed.map((point) => `${x(point.x).toFixed(1)} ${y(point.y.mean!).toFixed(1)}`).join("L");
    if (joined && placed.length > 1) g.append(svg("path", {d: `M${line}`, class: "line"}));
    for (const point of series.points) {
        const {low, high, mean} = point.y, at = x(point.x);
        if (is_number(low) && is_number(high) && high > 0) {
            const top = y(high), end = low > 0 ? Math.min(y(low), bottom) : bottom;
            g.append(svg("path", {d: `M${at} ${top}V${end}M${at - 3} ${top}h6${low > 0 ? `M${at - 3} ${end}h6` : ""}`, class: "bar"}));
        }
        if (!is_number(mean) || mean <= 0) continue;
        const shape = marker(series.colour, at, y(mean));
        shape.append(svg("title", {}, `${series.name}, ${point.label ?? number_text(point.x)}: ${estimate_text(point.y)}`));
        g.append(shape);
    }
    return g;
}

// null if there is nothing to draw.
export function plot(all: Series[], width: number, height: number, options: PlotOptions): SVGSVGElement | null {
    const points = all.flatMap((series) => series.points).filter((point) => !options.log_x || point.x > 0);
    const positive = (v: number | null | undefined): v is number => is_number(v) && v > 0;
    const means = points.map((point) => point.y.mean).filter(positive);
    if (!means.length) return null;
    // An interval that reaches down to almost nothing must not squeeze the rest.
    const floor = Math.min(...means) / 4;
    const lows = points.map((point) => point.y.low).filter(positive).map((low) => Math.max(low, floor));
    const highs = points.map((point) => point.y.high).filter(positive);
    const bottom = height - margin.bottom;
    const x = axis_scale(points.map((point) => point.x), [margin.left, width - margin.right], options.log_x);
    const y = axis_scale([...means, ...lows, ...highs, ...(options.level ? [options.level.y] : [])], [bottom, margin.top], true);
    const names = all.map((series) => series.name).join(", ");
    const root = svg("svg", {viewBox: `0 0 ${width} ${height}`, width, height, role: "img",
                             "aria-label": `${options.y_label} against ${options.x_label} of ${names}. The numbers are in the table below.`});
    root.append(draw_axes(x, y, width, height, options));
    if (options.level) {
        const at = y(options.level.y);
        root.append(svg("path", {d: `M${margin.left} ${at}H${width - margin.right}`, class: "level"}),
                    svg("text", {x: width - margin.right - 4, y: at - 5, "text-anchor": "end", class: "level"}, options.level.label));
    }
    root.append(...all.map((series) => draw_series({...series, points: series.points.filter((p) => points.includes(p))}, x, y, bottom,
        options.joined ?? true)));
    return root;
}
