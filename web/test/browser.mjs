// Pages in headless Chromium, opened from their files. Needs CHROMIUM (the program).
import assert from "node:assert/strict";
import {after, before} from "node:test";
import {pathToFileURL} from "node:url";
import {chromium} from "playwright-core";

export const desktop = {width: 1280, height: 900}, phone = {width: 360, height: 740};
let browser;

before(async () => {
    browser = await chromium.launch({
        executablePath: process.env.CHROMIUM,
        args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
               "--disable-component-update", "--disable-sync"],
    });
});
after(() => browser?.close());

// Opens a page, does `body` with it, and demands that nothing went wrong and nothing was asked of a network.
export async function open_page(file, options, body) {
    const context = await browser.newContext({viewport: desktop, offline: true, ...options});
    const page = await context.newPage(), wrong = [];
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && wrong.push(message.text()));
    page.on("pageerror", (error) => wrong.push(String(error)));
    page.on("request", (request) => /^(file|data):/.test(request.url()) || wrong.push(`asked for ${request.url()}`));
    try {
        await page.goto(pathToFileURL(file).href);
        await body(page);
        assert.deepEqual(wrong, []);
    } finally {
        await context.close();
    }
}
