// Files of the CNIL's PIA tool -> what its own code makes of each: imported, evaluated, exported. JSON in, JSON out.
//
// node round_trip.mjs CHECKOUT, where CHECKOUT is a copy of the tool's repository (LINCnil/pia). In: [text of a file, …].
// Out: [{exported: {…}, status: {item: number, …}, kept_open: [item, …]}, …]. The services are the tool's, compiled as
// they stand; what they write to is an IndexedDB in memory. Of Angular they use names only, and no server is asked.
import { readFileSync } from "node:fs";
import Module, { createRequire } from "node:module";
import { join } from "node:path";
import "fake-indexeddb/auto";

const require = createRequire(import.meta.url);
const ts = require("typescript");
const checkout = process.argv[2];

const OPTIONS = {
  module: ts.ModuleKind.CommonJS,
  target: ts.ScriptTarget.ES2022,
  experimentalDecorators: true,
  esModuleInterop: true,
  useDefineForClassFields: false, // as Angular compiles: a field that is declared again keeps its value
};
Module._extensions[".ts"] = (module, file) =>
  module._compile(ts.transpileModule(readFileSync(file, "utf8"), { compilerOptions: OPTIONS }).outputText, file);

// A decorator that changes nothing, a class without methods: all that the services ask of Angular when they load.
function Nothing() {
  return () => undefined;
}
const framework = new Proxy({}, { get: (_, name) => (name === "__esModule" ? true : Nothing) });
const load = Module._load;
const found = { rxjs: require.resolve("rxjs") };
Module._load = (request, ...more) => {
  if (request.startsWith("@")) return framework;
  return load(request.startsWith("src/") ? join(checkout, request) : (found[request] ?? request), ...more);
};

// The browser, as far as there is none.
const storage = new Map();
const localStorage = {
  getItem: (key) => storage.get(key) ?? null,
  setItem: (key, value) => storage.set(key, String(value)),
  removeItem: (key) => storage.delete(key),
};
class FileReader {
  readAsText(file) {
    file.text().then((result) => this.onload({ target: { result } }));
  }
}
const fetch = async (url) => ({ ok: false, status: 404, url, json: async () => ({}) }); // to the tool: no users, no server
Object.assign(globalThis, { localStorage, FileReader, fetch });
Object.assign(globalThis, { window: globalThis, location: { hash: "" }, alert: console.error });
console.log = console.error; // the answer alone goes to the output

const service = (name, type) => require(join(checkout, "src/app/services", `${name}.service.ts`))[type];
const router = { events: { subscribe: () => undefined }, navigate: () => undefined };
const translate = { instant: (key) => key, get: () => ({ subscribe: () => undefined }) };

function tool() {
  const api = new (service("api", "ApiService"))({}, translate);
  const made = (name, type, ...more) => new (service(name, type))(router, api, ...more);
  const evaluation = new (service("global-evaluation", "GlobalEvaluationService"))(api);
  return new (service("pia", "PiaService"))(
    router,
    new (service("app-data", "AppDataService"))(),
    new (service("sid-status", "SidStatusService"))(evaluation, api),
    undefined, // structures: an export has none
    made("answer", "AnswerService"),
    made("measures", "MeasureService", translate, {}),
    made("comments", "CommentsService"),
    made("evaluation", "EvaluationService"),
    { state: false }, // nobody is logged in
    api,
  );
}

const PARTS = ["answers", "measures", "evaluations", "comments"];
const pause = () => new Promise((resolve) => setTimeout(resolve, 10));

// The tool says that it is done before its database is: until all is there, or nothing comes for two seconds.
async function settled(pias, id, given) {
  let exported;
  for (let tries = 0; tries < 200; tries++) {
    exported = JSON.parse(await pias.export(id));
    if (PARTS.every((part) => exported[part].length >= given[part].length)) break;
    await pause();
  }
  return exported;
}

async function roundTrip(pias, text) {
  await pias.import(new Blob([text]));
  const all = await pias.findAll();
  const { id } = all[all.length - 1];
  const exported = await settled(pias, id, JSON.parse(text));
  const status = {};
  const kept_open = [];
  for (const section of pias.data.sections) {
    for (const item of section.items) {
      const checked = new (service("global-evaluation", "GlobalEvaluationService"))(pias.apiService);
      Object.assign(checked, { pia: exported.pia, section, item });
      const said = await checked.validate();
      status[said.reference_to] = said.status;
      if (checked.answerEditionEnabled) kept_open.push(said.reference_to);
    }
  }
  return { exported, status, kept_open };
}

const pias = tool();
while (!(await pias.findAll()).length) await pause(); // its own example comes first
const answers = [];
for (const text of JSON.parse(readFileSync(0, "utf8"))) answers.push(await roundTrip(pias, text));
process.stdout.write(JSON.stringify(answers));
