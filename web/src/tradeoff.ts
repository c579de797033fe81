// Speed against accuracy: each setting of each knob by the time of a mutation and the error, and what follows.
import {html, scrolling, section} from "./dom";
import {figure} from "./figure";
import {estimate_text, number_text} from "./format";
import {is_number, type Estimate, type Results, type Setting} from "./results";

type Quantity = "relmse" | "variance" | "squared_bias" | "efficiency";
const columns: [Quantity, string][] = [["relmse", "relMSE"], ["variance", "Variance"], ["squared_bias", "Squared bias"],
                                       ["efficiency", "Efficiency, 1 / (CPU s × relMSE)"]];

// Not worse than another in one of the two and not in both: what nothing else beats.
function on_front(setting: Setting, all: Setting[]): boolean {
    const time = setting.microseconds_per_mutation, error = setting.relmse?.mean;
    return is_number(error) && all.every((other) => other === setting || other.microseconds_per_mutation > time ||
        !is_number(other.relmse?.mean) || other.relmse.mean >= error);
}

function table(settings: [string, Setting][], all: Setting[]): HTMLTableElement {
    const cells = (estimate: Estimate | undefined): HTMLElement =>
        html("td", {}, estimate ? estimate_text(estimate) : "");
    return html("table", {}, html("thead", {}, html("tr", {}, ...["Knob", "Setting", "On the front", "µs per mutation",
        ...columns.map(([, name]) => name)].map((text) => html("th", {scope: "col"}, text)))),
        html("tbody", {}, ...settings.map(([knob, s]) => html("tr", {}, html("th", {scope: "row"}, knob),
            html("td", {}, s.value), html("td", {}, on_front(s, all) ? "yes" : ""),
            html("td", {}, number_text(s.microseconds_per_mutation)), ...columns.map(([key]) => cells(s[key]))))));
}

export function tradeoff_section({tradeoff = []}: Results): HTMLElement | null {
    const base = tradeoff[0]?.settings[0];
    if (!base) return null;
    const rows = tradeoff.flatMap(({knob, settings}): [string, Setting][] => settings.slice(1).map((s) => [knob, s]));
    const all = [base, ...rows.map(([, s]) => s)];
    const chart = figure("tradeoff-plot", [], () => ({
        x_label: "CPU time of a mutation (µs)", y_label: "relMSE at equal cost", log_x: true, joined: false,
        series: tradeoff.map(({knob, settings}, colour) => ({name: knob, colour, points: settings.flatMap((s) =>
            s.relmse ? [{x: s.microseconds_per_mutation, y: s.relmse, label: s.value}] : [])})),
    }));
    return section("tradeoff", "Speed against accuracy", html("p", {class: "note"},
        `One knob turned at a time, from ${base.entry}. Down and to the left is better; points that no other beats in both ` +
        "are marked in the table."),
        html("ul", {id: "conclusions"}, ...tradeoff.map(({knob, conclusion}) => html("li", {}, html("b", {}, knob), `: ${conclusion}`))),
        chart.element, scrolling("Settings", table([["(base)", base], ...rows], all)));
}
