// Builds the template of the page: one HTML file with the style, the script and the licences of what is bundled.
//   node build.mjs          writes template.html
//   node build.mjs --check  exits with 1 if template.html is not what the sources give
import {build} from "esbuild";
import {existsSync, readFileSync, writeFileSync} from "node:fs";
import {dirname, join} from "node:path";
import {fileURLToPath} from "node:url";

const root = dirname(fileURLToPath(import.meta.url));
const template = join(root, "template.html");

async function bundle(entry) {
    const result = await build({
        entryPoints: [join(root, "src", entry)],
        absWorkingDir: root,
        bundle: true,
        minify: true,
        charset: "utf8",
        format: "iife",
        target: ["chrome103", "firefox113", "safari16.4"],
        write: false,
        metafile: true,
    });
    return {text: result.outputFiles[0].text.trim(), inputs: Object.keys(result.metafile.inputs)};
}

// The licences of the packages from which an input was bundled; what packages have in common is there once.
function licences(inputs) {
    const packages = new Set(inputs.map((file) => /^node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(file)?.[1]).filter(Boolean));
    const names_of_text = new Map();
    for (const name of [...packages].sort()) {
        const folder = join(root, "node_modules", name);
        if (!existsSync(join(folder, "LICENSE"))) throw new Error(`${name} has no LICENSE to keep`);
        const text = readFileSync(join(folder, "LICENSE"), "utf8").trim();
        const {version} = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
        names_of_text.set(text, [...(names_of_text.get(text) ?? []), `${name} ${version}`]);
    }
    return [...names_of_text].map(([text, names]) => `${names.join(", ")}\n\n${text}`);
}

const escape = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");

const script = await bundle("page.ts");
const style = await bundle("style.css");
if (script.text.includes("</script") || script.text.includes("<!--")) throw new Error("the script would end early");
const parts = {
    STYLE: style.text,
    SCRIPT: script.text,
    LICENCES: escape(licences(script.inputs).join("\n\n\n")),
};
const html = readFileSync(join(root, "src/index.html"), "utf8").replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]);

if (process.argv.includes("--check")) {
    if (!existsSync(template) || readFileSync(template, "utf8") !== html) {
        console.error("web/template.html is not what web/src gives: run `npm run build` in web/ and commit the result");
        process.exit(1);
    }
} else {
    writeFileSync(template, html);
    console.log(`template.html: ${(Buffer.byteLength(html) / 1024).toFixed(1)} KiB`);
}
