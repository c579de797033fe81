// Puts the page together from the data that stands in it.
import {convergence_section, sweep_section} from "./charts";
import {html, section} from "./dom";
import {number_text, seconds_text} from "./format";
import {is_number, read_page_data, type Results} from "./results";
import {tradeoff_section} from "./tradeoff";
import {metrics_section, strategies_section, time_section} from "./tables";
import {viewer_section} from "./viewer_controls";

function budget_text({equal, budget}: Results): string | false {
    if (!is_number(budget)) return false;
    if (equal === "mutations") return `${number_text(budget)} mutations per pixel each`;
    return `${seconds_text(budget)} ${equal === "cpu" ? "of CPU time " : ""}each`;
}

function header(results: Results): HTMLElement {
    const {scene = {}, runs, threads} = results, entries = results.entries ?? [];
    const facts = [
        is_number(scene.width) && is_number(scene.height) && `${scene.width} × ${scene.height} pixels`,
        is_number(scene.max_length) && `path lengths to ${scene.max_length}`,
        entries.length > 0 && `${entries.length} ${entries.length === 1 ? "entry" : "entries"}`,
        is_number(runs) && `${runs} run${runs === 1 ? "" : "s"}`,
        budget_text(results),
        is_number(threads) && `${threads} thread${threads === 1 ? "" : "s"}`,
    ].filter(Boolean);
    return html("header", {}, html("p", {class: "kind"}, results.tradeoff ? "Keyhole trade-off" : entries.some((e) => e.parameter) ? "Keyhole sweep" : "Keyhole comparison"),
                html("h1", {}, scene.name ?? scene.file ?? "Unnamed scene"), html("p", {class: "facts"}, facts.join("  ·  ")));
}

// Those of entries, of which there can be many, are folded.
function warnings(results: Results): HTMLElement | null {
    const list = (texts: string[]) => (texts.length ? html("ul", {}, ...texts.map((text) => html("li", {}, text))) : null);
    const warned = (results.entries ?? []).filter((e) => e.warnings?.length), whole = results.warnings ?? [];
    if (!whole.length && !warned.length) return null;
    return html("aside", {class: "warnings", "aria-label": "Warnings"}, list(whole), warned.length ? html("details", {},
        html("summary", {}, `Warnings of ${warned.map((e) => e.name).join(", ")}`),
        list(warned.flatMap((e) => (e.warnings ?? []).map((text) => `${e.name}: ${text}`)))) : null);
}

function mixes_section({entries = []}: Results): HTMLElement | null {
    const listed = entries.filter((entry) => entry.mix || entry.description);
    return listed.length ? section("mixes", "Mixes", ...listed.map((entry) => html("details", {},
        html("summary", {}, entry.name, entry.description ? html("span", {class: "note"}, ` – ${entry.description}`) : null),
        html("pre", {tabindex: 0, "aria-label": `Mix file of ${entry.name}`}, entry.mix ?? "")))) : null;
}

function origin_section(results: Results): HTMLElement {
    const r = results.reference, facts: [string, string | false | undefined][] = [
        ["Scene", results.scene?.file],
        ["Reference", r && [r.integrator, is_number(r.samples_per_pixel) && `${number_text(r.samples_per_pixel)} samples per pixel`,
            is_number(r.seconds) && seconds_text(r.seconds), is_number(r.relmse) && `its own relMSE ${number_text(r.relmse)}`, r.file]
            .filter(Boolean).join(", ")],
        ["Seed", is_number(results.seed) && String(results.seed)],
        ["Keyhole", results.keyhole], ["Machine", results.machine], ["Made", results.created],
    ];
    return section("origin", "How to repeat it",
        results.command ? html("pre", {class: "command", tabindex: 0, "aria-label": "Command"}, results.command) : null,
        html("dl", {}, ...facts.flatMap(([name, text]) => (text ? [html("dt", {}, name), html("dd", {}, text)] : []))));
}

const data = read_page_data(), {results} = data;
document.title = `${results.scene?.name ?? results.scene?.file ?? "Scene"} – Keyhole`;
document.getElementById("page")!.replaceChildren(...[header(results), warnings(results), viewer_section(data),
    tradeoff_section(results),
    convergence_section(results), sweep_section(results), metrics_section(results), strategies_section(results),
    time_section(results), mixes_section(results), origin_section(results)].filter((part) => part !== null));
