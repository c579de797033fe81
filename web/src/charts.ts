// Error against time, and against a varied parameter.
import {html, section, select} from "./dom";
import {figure} from "./figure";
import {metric_names} from "./tables";
import type {ConvergencePoint, Entry, Estimate, Results} from "./results";

type Quantity = "relmse" | "variance" | "squared_bias";
type Effort = "seconds" | "cpu_seconds" | "mutations";
const quantities: [Quantity, string][] = [["relmse", "relMSE"], ["variance", "Variance"], ["squared_bias", "Squared bias"]];
const efforts: [Effort, string][] = [["seconds", "Time (s)"], ["cpu_seconds", "CPU time (s)"], ["mutations", "Mutations"]];

export function convergence_section({entries = [], equal, reference}: Results): HTMLElement | null {
    const points = entries.flatMap((entry) => entry.convergence ?? []);
    const has = (key: keyof ConvergencePoint): boolean => points.some((point) => point[key] !== undefined);
    const ys = quantities.filter(([key]) => has(key)), xs = efforts.filter(([key]) => has(key));
    if (!ys.length || !xs.length) return null;
    let y = ys[0]![0];
    const wanted: Effort = equal === "mutations" ? "mutations" : equal === "cpu" ? "cpu_seconds" : "seconds";
    let x = (xs.find(([key]) => key === wanted) ?? xs[0]!)[0];
    const label = (list: [string, string][], key: string): string => list.find(([k]) => k === key)![1];
    const chart = figure("convergence-plot", [
        select("Error", ys, y, (key) => { y = key as Quantity; chart.redraw(); }),
        select("against", xs, x, (key) => { x = key as Effort; chart.redraw(); }),
    ], () => ({
        x_label: label(xs, x), y_label: label(ys, y), log_x: true,
        level: y === "relmse" && reference?.relmse ? {y: reference.relmse, label: "noise of the reference"} : undefined,
        series: entries.map((entry, colour) => ({name: entry.name, colour, points: (entry.convergence ?? []).flatMap((point) =>
            point[x] !== undefined && point[y] ? [{x: point[x]!, y: point[y]!}] : [])}))
            .filter((series) => series.points.length),
    }));
    return section("convergence", "Convergence", html("p", {class: "note"},
        "Means over runs with 95% intervals; both axes logarithmic. An estimate of variance or squared bias that is not " +
        "positive has no point, only the upper part of its interval."), chart.element);
}

// One line, through the entries that carry the parameter.
export function sweep_section({entries = []}: Results): HTMLElement | null {
    const swept = entries.filter((entry): entry is Entry & Required<Pick<Entry, "parameter">> => entry.parameter !== undefined);
    const parameter = swept[0]?.parameter.name;
    if (parameter === undefined) return null;
    const same = swept.filter((entry) => entry.parameter.name === parameter)
                      .sort((a, b) => a.parameter.value - b.parameter.value);
    const measures: [string, string, (entry: Entry) => Estimate | undefined][] = [
        ...Object.entries(metric_names).map(([key, name]): [string, string, (e: Entry) => Estimate | undefined] =>
            [key, name, (entry) => entry.metrics?.[key]]),
        ["variance", "Variance", (entry) => entry.split?.variance],
        ["squared_bias", "Squared bias", (entry) => entry.split?.squared_bias],
        ["speed_up", "Speed-up", (entry) => entry.speed_up],
    ];
    const known = measures.filter(([, , of]) => same.some(of));
    if (!known.length) return null;
    let chosen = known.find(([key]) => key === "relmse") ?? known[0]!;
    const values = same.map((entry) => entry.parameter.value);
    const log_x = values[0]! > 0 && values.at(-1)! / values[0]! > 8;
    const chart = figure("sweep-plot", [
        select("Measure", known.map(([key, name]) => [key, name]), chosen[0],
               (key) => { chosen = known.find(([k]) => k === key)!; chart.redraw(); }),
    ], () => ({
        x_label: parameter, y_label: chosen[1], log_x,
        series: [{name: `${parameter} varied`, colour: 0, points: same.flatMap((entry) => {
            const y = chosen[2](entry);
            return y ? [{x: entry.parameter.value, y}] : [];
        })}],
    }));
    return section("sweep", `Error against ${parameter}`, chart.element);
}
