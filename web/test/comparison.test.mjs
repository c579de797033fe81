// What `keyhole compare`, `keyhole sweep` and `keyhole tradeoff` write, in a real browser. Needs CHROMIUM and COMPARISONS, a
// folder with the folders of comparisons of mmlt, path and bdpt, one sweep, "sweep", and one trade-off, "tradeoff".
import assert from "node:assert/strict";
import {readFileSync, readdirSync} from "node:fs";
import {join} from "node:path";
import {test} from "node:test";
import {open_page} from "./browser.mjs";
import {validate} from "./schema.mjs";

const folder = process.env.COMPARISONS;

for (const name of readdirSync(folder)) {
    const results = JSON.parse(readFileSync(join(folder, name, "results.json"), "utf8"));
    const names = results.entries.map((entry) => entry.name);

    test(`${name}: the results follow docs/results.schema.json`, () => {
        assert.ok(validate(results), JSON.stringify(validate.errors, null, 1));
        if (!["sweep", "tradeoff"].includes(name)) assert.deepEqual(names, ["mmlt", "path", "bdpt"]);
        for (const entry of results.entries) {
            assert.equal(entry.runs, results.runs);
            assert.ok(entry.metrics.relmse.low < entry.metrics.relmse.high);
            // The trade-off is over in a pass or two.
            assert.ok(entry.convergence.length >= (name === "tradeoff" ? 1 : 2));
        }
    });

    test(`${name}: the page shows every entry and the reference`, () => open_page(join(folder, name, "index.html"), {}, async (page) => {
        const viewer = page.locator("#viewer[data-ready=true]");
        await viewer.waitFor();
        for (const [i, shown] of ["reference", ...names.slice(0, 9)].entries()) {
            await page.keyboard.press(String(i));
            await page.waitForFunction((wanted) => {
                const data = document.getElementById("viewer").dataset;
                return data.ready === "true" && data.shown === wanted;
            }, shown, {timeout: 5000});
        }
        assert.equal(await page.locator("#conclusions li").count(), name === "tradeoff" ? 2 : 0);
        assert.equal(await page.locator("#tradeoff-plot svg[role=img]").count(), name === "tradeoff" ? 1 : 0);
        await page.screenshot({path: join(folder, name, "page.png"), fullPage: true});
    }));
}
