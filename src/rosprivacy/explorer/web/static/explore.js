// The explorer's page: forms and links are sent without loading the page anew, keys press what stands on it, and the
// picture is moved. It decides nothing: what is shown is made by the server, and without this script all of it works.
"use strict";

const PARTS = "[data-part]";
const SECONDS = 2; // between two looks at what others did
const body = document.body;
const one = (selector, inside = document) => inside.querySelector(selector);
const all = (selector, inside = document) => [...inside.querySelectorAll(selector)];
let busy = false;

// --- parts of the page ------------------------------------------------------------------------------------------

async function ask(address, options, keep) {
  if (busy) return; // a second key must not answer a question that nobody has seen
  busy = true;
  body.setAttribute("aria-busy", "true");
  try {
    const answer = await fetch(address, { ...options, headers: { Accept: "text/html" } });
    if (!(answer.headers.get("content-type") || "").startsWith("text/html")) throw new Error(await answer.text());
    const text = await answer.text();
    const page = new DOMParser().parseFromString(text, "text/html");
    if (!page.body.dataset.version) throw new Error(page.body.textContent);
    put(page, keep);
    const shown = new URL(answer.url);
    if (answer.ok) history.replaceState(null, "", shown.pathname + shown.search);
  } catch (error) {
    tell("gone", error instanceof TypeError ? "" : error.message);
  } finally {
    busy = false;
    body.removeAttribute("aria-busy");
  }
}

function put(page, keep) {
  const before = one("#head h1").textContent;
  const scrolled = one("#list").scrollTop;
  const held = document.activeElement?.dataset?.key; // what had the focus and is put in place anew
  for (const part of all(PARTS)) {
    const fresh = one(`#${part.id}`, page);
    if (fresh) part.replaceWith(document.adoptNode(fresh));
  }
  document.title = page.title;
  one("#find").value = one("#find", page).value;
  one("#list").scrollTop = scrolled;
  if (keep !== "tick") one("#element").scrollTop = 0;
  ready();
  if ((keep === "none" || keep === "tick") && held) one(`[data-key="${CSS.escape(held)}"]`)?.focus();
  focusNext(keep);
  const head = one("#head h1").textContent;
  const message = one("#message").textContent.trim();
  one("#said").textContent = [one("#trial").textContent.trim(), message, head === before ? "" : head, one("#head .verdict p").textContent].join(" ").trim();
  one("#elsewhere").hidden = true;
  body.dataset.version = page.body.dataset.version; // last: who waits for it sees the page as it is now
}

function focusNext(keep) {
  const screen = one(".screen");
  if (screen) return focusScreen(screen, keep);
  if (keep === "row" && matchMedia("(max-width: 60rem)").matches) return pane("element");
  if (keep === "answer" && matchMedia("(max-width: 60rem)").matches) pane("element");
  if (keep === "none") return;
  const next = one("#rows [aria-current]");
  next?.focus({ preventScroll: true });
  next?.scrollIntoView({ block: "nearest" });
}

// Enter takes what is ticked on a screen, and follows no link of the list.
function focusScreen(screen, keep) {
  if (keep === "tick" && screen.contains(document.activeElement)) return;
  screen.focus({ preventScroll: true });
  if (keep === "tick" || !matchMedia("(max-width: 60rem)").matches) return;
  pane("element");
  (one("#message").textContent.trim() ? one("#message") : screen).scrollIntoView({ block: "start" });
}

// What the page has only with this script.
function ready() {
  for (const hidden of all("button[data-act][hidden], nav.tabs[hidden]")) hidden.hidden = false;
  const drawn = one(".drawn > svg");
  if (drawn) look(drawn);
}

document.addEventListener("submit", (event) => {
  const form = event.target;
  const method = form.getAttribute("method"); // form.method can be a field of that name
  if (method === "dialog") return;
  event.preventDefault();
  const fields = new URLSearchParams(new FormData(form, event.submitter));
  const whose = form.matches(".offer") && one("#answers [name=whose]:checked"); // as a person chose it below
  if (whose) fields.set("whose", whose.value);
  const address = new URL(form.getAttribute("action"), location.href);
  if (method === "post") return void ask(address, { method: "POST", body: fields }, event.submitter?.name === "tick" ? "tick" : "answer");
  address.search = fields;
  ask(address, {}, "row");
});

document.addEventListener("click", (event) => {
  const link = event.target.closest("a[data-swap], a[data-element]");
  if (link && !event.ctrlKey && !event.metaKey && !event.shiftKey && event.button === 0) {
    event.preventDefault();
    const shows = link.dataset.shows; // a part further down, which is what was asked for
    const asked = ask(link.getAttribute("href"), {}, link.matches(".switch, .button:not([data-leads])") ? "none" : "row");
    return void asked.then(() => shows && one(`#${shows}`)?.scrollIntoView({ block: "start" }));
  }
  const button = event.target.closest("button");
  if (button?.dataset.pane) pane(button.dataset.pane);
  if (button?.dataset.act === "help") one("#help").showModal();
  if (button?.dataset.act === "fit") fit(one(".drawn > svg"));
  if (button?.dataset.act === "reload") ask(location.href, {}, "row");
});

// On a narrow screen one pane is seen at a time.
function pane(name) {
  body.dataset.pane = name;
  for (const tab of all(".tabs button")) tab.setAttribute("aria-pressed", tab.dataset.pane === name);
  if (name === "picture") look(one(".drawn > svg")); // it had no size before
  if (name === "element") one("#h-ask")?.scrollIntoView({ block: "nearest" });
}

// --- keys ---------------------------------------------------------------------------------------------------------

const typing = (target) => target.matches("input:not([type=checkbox], [type=radio]), select, textarea") || one("dialog[open]");

document.addEventListener("keydown", (event) => {
  if ((event.ctrlKey || event.metaKey) && event.key === "s") {
    event.preventDefault();
    return press("Ctrl+S");
  }
  if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing || event.repeat) return;
  if (event.key === "Escape" && typing(event.target)) return event.target.blur?.();
  if (typing(event.target)) return;
  if (event.key === "/") {
    event.preventDefault();
    pane("list");
    one("#find").focus();
    return one("#find").select(); // what was looked for before is typed over
  }
  if (event.key === "Enter" && event.target.closest("a, button:not([role=checkbox]), summary")) return; // it presses that
  if (event.key === "j" || event.key === "k") return step(event.key === "j" ? 1 : -1);
  if (press(event.key)) event.preventDefault(); // else the letter goes on into what is focused now
});

function press(key) {
  const found = one(`[data-key="${CSS.escape(key)}"]:not([hidden]):not(:disabled)`);
  if (!found || found.closest("fieldset:disabled")) return false;
  found.click();
  if (found.matches("summary") && found.parentElement.open) one("select, input, button", found.parentElement)?.focus();
  return true;
}

function step(by) {
  const rows = all("#rows a.row").filter((row) => row.offsetParent || row.closest("details"));
  const at = rows.findIndex((row) => row.matches("[aria-current]"));
  const next = rows[Math.min(rows.length - 1, Math.max(0, at + by))];
  if (next && next !== rows[at]) next.click();
}

// --- the picture --------------------------------------------------------------------------------------------------

const READABLE = 0.8; // a picture is not made smaller than that unless a person asks for it
let zoom = null; // what a person made it

function look(svg) {
  for (const side of ["width", "height"]) svg.dataset[side] ??= svg.getAttribute(side);
  const area = svg.closest(".drawn");
  if (zoom === null) scale(svg, whole(svg) < READABLE ? 1 : whole(svg));
  else sized(svg, zoom);
  const box = one(".box.focus", svg)?.getBoundingClientRect();
  if (!box) return;
  const room = area.getBoundingClientRect();
  area.scrollLeft += box.x + box.width / 2 - (room.x + room.width / 2);
  area.scrollTop += box.y + box.height / 2 - (room.y + room.height / 2);
}

function scale(svg, by) {
  for (const side of ["width", "height"]) svg.setAttribute(side, svg.dataset[side] * by);
}

function sized(svg, by) {
  zoom = Math.min(3, Math.max(0.2, by));
  scale(svg, zoom);
}

// How large the whole picture can be.
function whole(svg) {
  const area = svg.closest(".drawn");
  return Math.min(1, area.clientWidth / svg.dataset.width, area.clientHeight / svg.dataset.height);
}

// The whole picture, or what of it can be read.
function fit(svg) {
  zoom = zoom === whole(svg) ? 1 : whole(svg);
  look(svg);
}

document.addEventListener("wheel", (event) => {
  const svg = event.target.closest?.(".drawn > svg");
  if (!svg || !event.ctrlKey) return; // without Ctrl the wheel scrolls, as everywhere
  event.preventDefault();
  const area = svg.closest(".drawn");
  const [room, before] = [area.getBoundingClientRect(), svg.getAttribute("width") / svg.dataset.width];
  const [x, y] = [event.clientX - room.x, event.clientY - room.y];
  sized(svg, before * (event.deltaY > 0 ? 1 / 1.15 : 1.15));
  area.scrollLeft = (area.scrollLeft + x) * (zoom / before) - x;
  area.scrollTop = (area.scrollTop + y) * (zoom / before) - y;
}, { passive: false });

let held = null;
document.addEventListener("pointerdown", (event) => {
  const area = event.target.closest?.(".drawn");
  if (area && event.pointerType === "mouse" && event.button === 0)
    held = { area, x: event.clientX + area.scrollLeft, y: event.clientY + area.scrollTop };
});
document.addEventListener("pointermove", (event) => {
  if (held) held.area.scrollTo(held.x - event.clientX, held.y - event.clientY);
});
document.addEventListener("pointerup", () => { held = null; });
document.addEventListener("dragstart", (event) => { if (event.target.closest?.(".drawn")) event.preventDefault(); });

// --- other windows, the file ----------------------------------------------------------------------------------------

function tell(what, more = "") {
  const line = one("#elsewhere span");
  one("#elsewhere").hidden = false;
  line.textContent = [line.dataset[what], more].filter(Boolean).join(" ").slice(0, 400);
}

async function news() {
  if (!busy && !document.hidden) {
    try {
      const now = await (await fetch("/now")).json();
      if (!busy && String(now.version) !== body.dataset.version) tell("changed");
      else if (now.disk && !one("#message pre")) tell("disk");
      else if (now.inputs && now.inputs !== one("#inputs")?.textContent) tell("inputs", now.inputs);
    } catch {
      return tell("gone");
    }
  }
  setTimeout(news, SECONDS * 1000);
}

ready();
pane(body.dataset.pane);
setTimeout(news, SECONDS * 1000);
