// The tables: errors, strategies, where the time went.
import {html, scrolling, section} from "./dom";
import {interval_text, number_text, percent_text} from "./format";
import {is_number, type Entry, type Estimate, type Results} from "./results";

export const metric_names: Record<string, string> = {
    mse: "MSE", rmse: "RMSE", rrmse: "rRMSE", relmse: "relMSE", relmse_trimmed: "relMSE, trimmed", mape: "MAPE",
    smape: "SMAPE", mean_ratio: "Mean ratio"};

type Column = [name: string, of: (entry: Entry) => Estimate | undefined, better: "low" | "high" | "none", digits?: number];

function head(...names: string[]): HTMLElement {
    return html("thead", {}, html("tr", {}, ...names.map((name) => html("th", {scope: "col"}, name))));
}

const words = (key: string): string => key.replaceAll("_", " ").replace(/^./, (letter) => letter.toUpperCase());

function estimate_cell(estimate: Estimate | undefined, best: boolean, digits = 3): HTMLElement {
    const mean = number_text(estimate?.mean, digits);
    return html("td", {}, best ? html("strong", {title: "best mean"}, mean) : mean,
                html("small", {}, interval_text(estimate, digits)));
}

function best_entry(entries: Entry[], [, of, better]: Column): Entry | undefined {
    if (better === "none" || entries.length < 2) return undefined;
    const sign = better === "low" ? 1 : -1;
    return entries.filter((entry) => is_number(of(entry)?.mean))
                  .sort((a, b) => sign * (of(a)!.mean! - of(b)!.mean!))[0];
}

export function metrics_section({entries = []}: Results): HTMLElement | null {
    const found = new Set(entries.flatMap((entry) => Object.keys(entry.metrics ?? {})));
    const keys = [...Object.keys(metric_names).filter((key) => found.has(key)), ...[...found].filter((key) => !(key in metric_names))];
    const columns: Column[] = [
        ["Speed-up", (e) => e.speed_up, "high"],
        ...keys.map((key): Column => [metric_names[key] ?? words(key), (e) => e.metrics?.[key],
                                ...(key === "mean_ratio" ? ["none", 5] as const : ["low"] as const)]),
        ["Variance", (e) => e.split?.variance, "low"],
        ["Squared bias", (e) => e.split?.squared_bias, "none"],
        ["Mutations/s", (e) => e.mutations_per_second, "none"],
    ];
    const shown = columns.filter(([, of]) => entries.some(of));
    if (!shown.length) return null;
    const best = shown.map((column) => best_entry(entries, column));
    const rows = entries.map((entry) => html("tr", {}, html("th", {scope: "row"}, entry.name, is_number(entry.runs) &&
        html("small", {}, `${entry.runs} run${entry.runs === 1 ? "" : "s"}`)),
        ...shown.map(([, of, , digits], i) => estimate_cell(of(entry), best[i] === entry, digits))));
    return section("errors", "Errors", html("p", {class: "note"},
        "Mean over runs, below it the 95% interval. Bold is the best mean, which a neighbour with an overlapping interval " +
        "may share. The speed-up is over the first entry, at equal error. Variance and squared bias are relative to the " +
        "reference as relMSE is, and its own variance is taken out."),
        scrolling("Error metrics", html("table", {id: "metric-table"}, head("Entry", ...shown.map(([name]) => name)), html("tbody", {}, ...rows))));
}

export function strategies_section({entries = []}: Results): HTMLElement | null {
    const listed = entries.filter((entry) => entry.strategies?.length);
    if (!listed.length) return null;
    const kinds = [...new Set(listed.flatMap((e) => e.strategies!.flatMap((s) => Object.keys(s.failures ?? {}))))];
    const body = (entry: Entry): HTMLElement => html("tbody", {},
        html("tr", {class: "group"}, html("th", {scope: "rowgroup", colspan: 6 + kinds.length}, entry.name)),
        ...entry.strategies!.map((s) => {
            const share = (count: number | undefined): string =>
                is_number(count) && is_number(s.proposals) && s.proposals > 0 ? percent_text(count / s.proposals) : "–";
            return html("tr", {}, html("th", {scope: "row"}, s.name), ...[number_text(s.proposals), share(s.accepted),
                percent_text(s.mean_acceptance), number_text(s.effective_sample_size), number_text(s.autocorrelation_time),
                ...kinds.map((kind) => share(s.failures?.[kind]))].map((text) => html("td", {}, text)));
        }));
    return section("strategies", "Strategies", html("p", {class: "note"},
        "Accepted and the failures are shares of the proposals. ESS: effective sample size; τ: autocorrelation time, in mutations."),
        scrolling("Acceptance and failures by strategy", html("table", {},
            head("Strategy", "Proposals", "Accepted", "Mean acceptance", "ESS", "τ", ...kinds.map(words)), ...listed.map(body))));
}

const parts = ["tracing", "shading", "inversion", "cones", "film", "other"];

export function time_section({entries = []}: Results): HTMLElement | null {
    const listed = entries.filter((entry) => entry.time_split);
    if (!listed.length) return null;
    const found = new Set(listed.flatMap((entry) => Object.keys(entry.time_split!)));
    const keys = [...parts.filter((part) => found.has(part)), ...[...found].filter((part) => !parts.includes(part))];
    const rows = listed.map((entry) => {
        const bar = html("div", {class: "stack", "aria-hidden": "true"}, ...keys.map((key, i) =>
            html("span", {style: `flex-grow:${entry.time_split![key] ?? 0};background:var(--c${i % 12})`})));
        return html("tr", {}, html("th", {scope: "row"}, entry.name), html("td", {class: "wide"}, bar),
                    ...keys.map((key) => html("td", {}, percent_text(entry.time_split![key]))));
    });
    const names = keys.map((key, i) => html("th", {scope: "col"},
        html("span", {class: "key", style: `background:var(--c${i % 12})`, "aria-hidden": "true"}), words(key)));
    return section("time", "Where the time went", scrolling("Shares of the time", html("table", {}, html("thead", {},
        html("tr", {}, html("th", {scope: "col"}, "Entry"), html("td", {}), ...names)), html("tbody", {}, ...rows))));
}
