"use strict";
(() => {
  const contents = document.querySelector("#contents details");
  contents.open = matchMedia("(min-width: 68rem)").matches;
  addEventListener("beforeprint", () => { contents.open = true; });
  const form = document.getElementById("filters");
  const ways = [...document.querySelectorAll("article.way")].map((way) => ({
    way, text: way.textContent.toLowerCase(), ...way.dataset,
  }));
  const show = () => {
    const asked = Object.fromEntries([...form.elements].filter((field) => field.name).map((field) => [field.name, field.value]));
    const words = asked.words.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const { way, text, ...is } of ways) {
      const fits = words.every((word) => text.includes(word))
        && ["category", "article9", "kind", "state"].every((what) => !asked[what] || is[what] === asked[what]);
      way.classList.toggle("off", !fits);
      shown += fits ? 1 : 0;
    }
    for (const kind of document.querySelectorAll("section.kind")) {
      const filtered = shown < ways.length;
      kind.classList.toggle("off", filtered && !kind.querySelector("article.way:not(.off)"));
    }
    const said = document.getElementById("shown");
    said.textContent = said.dataset.said.replace("{shown}", shown).replace("{all}", ways.length);
  };
  const reveal = () => {
    const target = document.querySelector(":target");
    if (form && target && target.closest("article.way.off, section.kind.off")) {
      form.reset();
      show();
      target.scrollIntoView();
    }
  };
  if (form) {
    form.hidden = false;
    form.addEventListener("input", show);
    form.addEventListener("submit", (event) => event.preventDefault());
    form.addEventListener("reset", () => setTimeout(show));
    addEventListener("hashchange", reveal);
    show();
    reveal();
  }
  for (const search of document.querySelectorAll(".search")) {
    const rows = [...document.getElementById(search.dataset.of).querySelectorAll("tbody tr")]
      .map((row) => ({ row, text: row.textContent.toLowerCase() }));
    const said = search.querySelector("[role=status]");
    const find = () => {
      const words = search.querySelector("input").value.toLowerCase().split(/\s+/).filter(Boolean);
      let shown = 0;
      for (const { row, text } of rows) {
        const fits = words.every((word) => text.includes(word));
        row.classList.toggle("off", !fits);
        shown += fits ? 1 : 0;
      }
      said.textContent = said.dataset.said.replace("{shown}", shown).replace("{all}", rows.length);
    };
    search.hidden = false;
    search.addEventListener("input", find);
    find();
  }
  document.documentElement.classList.add("js");
  const fields = [...document.querySelectorAll("textarea[data-field]")];
  let changed = false;
  for (const field of fields) {
    field.addEventListener("input", () => {
      changed = true;
      field.nextElementSibling.textContent = field.value;
    });
  }
  addEventListener("beforeunload", (event) => { if (changed) event.preventDefault(); });
  const save = document.getElementById("save");
  save.parentElement.hidden = false;
  save.addEventListener("click", () => {
    const filled = fields.filter((field) => field.value.trim()).map((field) => [field.dataset.field, field.value]);
    const answers = Object.fromEntries(filled.sort(([one], [other]) => (one < other ? -1 : 1)));
    const text = `${JSON.stringify({ format: "rosprivacy.assessment/1", answers }, null, 2)}\n`;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type: "application/json" }));
    link.download = "assessment.json";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href));
    changed = false;
  });
})();
