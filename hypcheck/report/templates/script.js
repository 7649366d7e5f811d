"use strict";
// Tables that sort by a click on a column and filter by a word; tooltips for fingers; everything unfolded on paper.
const FILTERED_FROM = 8;

function value(cell) {
  if (cell === undefined) return "";
  return cell.dataset.v === undefined ? cell.textContent.trim() : Number(cell.dataset.v.replace("inf", "Infinity"));
}

function compare(a, b) {
  if (typeof a === "number" && typeof b === "number") return a - b;
  if (typeof a !== typeof b) return typeof a === "number" ? -1 : 1;
  return a.localeCompare(b, "en", { numeric: true });
}

function sort(table, heads, place, original) {
  const states = ["none", "ascending", "descending"];
  const next = states[(states.indexOf(heads[place].getAttribute("aria-sort")) + 1) % 3];
  heads.forEach((head, at) => head.setAttribute("aria-sort", at === place ? next : "none"));
  const sign = next === "descending" ? -1 : 1;
  const rows = original.slice();
  if (next !== "none") {
    rows.sort((a, b) => sign * compare(value(a.cells[place]), value(b.cells[place])) || original.indexOf(a) - original.indexOf(b));
  }
  table.tBodies[0].append(...rows);
}

function sortable(table) {
  const heads = [...table.tHead.rows[0].cells];
  const original = [...table.tBodies[0].rows];
  heads.forEach((head, place) => {
    if (!head.textContent.trim()) return;
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    head.setAttribute("aria-sort", "none");
    button.addEventListener("click", () => sort(table, heads, place, original));
  });
}

function filtered(table, place) {
  const rows = [...table.tBodies[0].rows];
  if (rows.length < FILTERED_FROM) return;
  const texts = rows.map((row) => row.textContent.toLowerCase());
  const line = document.createElement("p");
  const label = document.createElement("label");
  const input = document.createElement("input");
  const count = document.createElement("output");
  line.className = "filter";
  input.type = "search";
  input.id = `filter-${place}`;
  label.htmlFor = input.id;
  label.textContent = `Filter ${table.caption.textContent}`;
  const show = () => {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    rows.forEach((row, at) => {
      row.hidden = !words.every((word) => texts[at].includes(word));
      shown += row.hidden ? 0 : 1;
    });
    count.textContent = `${shown} of ${rows.length} rows`;
  };
  input.addEventListener("input", show);
  line.append(label, input, count);
  table.parentElement.before(line);
  show();
}

function tipped(figure) {
  if (!figure.querySelector("g title")) return;
  const tip = document.createElement("output");
  tip.className = "tip";
  figure.append(tip);
  const show = (event) => {
    const title = event.target.closest("g > *")?.querySelector(":scope > title");
    if (title) tip.textContent = title.textContent;
  };
  figure.addEventListener("pointerover", show);
  figure.addEventListener("click", show);
}

document.querySelectorAll(".table table").forEach((table, place) => {
  sortable(table);
  filtered(table, place);
});
document.querySelectorAll("figure").forEach(tipped);

let folded = [];
addEventListener("beforeprint", () => {
  folded = [...document.querySelectorAll("details:not([open])")];
  folded.forEach((each) => (each.open = true));
});
addEventListener("afterprint", () => folded.forEach((each) => (each.open = false)));
