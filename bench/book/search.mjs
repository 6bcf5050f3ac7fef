// Searches the built book as its pages do: the title of each page must find the page.
// usage: node search.mjs FOLDER      FOLDER: the built book
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import vm from "node:vm";

// Pages without a title of their own: all pages in one, the list of pages, the answer to a wrong address.
const LEFT_OUT = ["print.html", "toc.html", "404.html"];

const folder = process.argv[2];
const files = readdirSync(folder, { recursive: true });

/** Runs the script of the book whose name begins with this, beside an object `window`. */
function load(name) {
    const file = files.find((file) => file.startsWith(`${name}-`) && file.endsWith(".js"));
    if (!file) throw new Error(`${folder} has no ${name}-*.js: the book is built without search, or by another mdbook`);
    vm.runInContext(readFileSync(join(folder, file), "utf8"), context);
}

const window = { search: {} };
const context = vm.createContext({ window });
load("elasticlunr");
load("searchindex");
const { doc_urls, index, results_options, search_options } = window.search;
const lunr = (context.elasticlunr ?? window.elasticlunr).Index.load(index);

/** Pages that a search shows. */
function search(words) {
    const found = lunr.search(words, search_options).slice(0, results_options.limit_results);
    return found.map(({ ref }) => doc_urls[ref].split("#")[0]);
}

const pages = files.filter((file) => file.endsWith(".html") && !LEFT_OUT.includes(file));
let failures = 0;
for (const page of pages) {
    const title = readFileSync(join(folder, page), "utf8").match(/<h1 id="[^"]*">(.*?)<\/h1>/s)?.[1];
    const words = title?.replace(/<[^>]*>/g, "").replace(/&[a-z]+;/g, " ");
    if (!words || !search(words).includes(page)) {
        console.log(`${page}: a search for its title "${words}" does not find it`);
        failures += 1;
    }
}
if (search("zzzznosuchword").length > 0) {
    console.log("a search for a word that no page has finds pages");
    failures += 1;
}
console.log(`search: ${pages.length} pages, ${failures} not found`);
process.exit(failures > 0 || pages.length === 0 ? 1 : 0);
