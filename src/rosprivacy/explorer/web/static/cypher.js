// The page of questions to the database: keys press what stands on it, and it is said that an answer is waited for.
// Without this script all of it works by forms and links.
"use strict";

const one = (selector, inside = document) => inside.querySelector(selector);
const typing = (target) => target.matches("input, select, textarea");

document.addEventListener("keydown", (event) => {
  if ((event.ctrlKey || event.metaKey) && event.key === "Enter") {
    const form = event.target.form || event.target.closest("form") || one("form.ask");
    event.preventDefault();
    return one("button[value=ask]", form).click();
  }
  if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing || event.repeat) return;
  if (event.key === "Escape" && typing(event.target)) return event.target.blur();
  if (typing(event.target)) return;
  if (event.key === "j" || event.key === "k") return step(event.key === "j" ? 1 : -1);
  const there = { e: "#text", g: "#answer" }[event.key];
  if (there) {
    event.preventDefault(); // else the letter goes on into what is focused now
    return one(there)?.focus();
  }
  if (event.key === "Escape") one("[data-key=Escape]").click();
});

// To the next question, or to the one before; Enter opens it.
function step(by) {
  const rows = [...document.querySelectorAll("#questions a.row")];
  const held = rows.indexOf(document.activeElement);
  const at = held < 0 ? rows.findIndex((row) => row.matches("[aria-current]")) : held;
  rows[Math.min(rows.length - 1, Math.max(0, at + by))].focus();
}

document.addEventListener("submit", (event) => {
  if (document.body.hasAttribute("aria-busy")) return event.preventDefault(); // one answer is waited for already
  document.body.setAttribute("aria-busy", "true");
  one("#said").textContent = one("#said").dataset.asking;
});
// A page that a browser kept and shows again waits for nothing.
window.addEventListener("pageshow", () => document.body.removeAttribute("aria-busy"));

one("#questions [aria-current]")?.scrollIntoView({ block: "nearest" });
if (location.hash === "#answer") one("#answer")?.focus({ preventScroll: true });
