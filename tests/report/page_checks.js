// What page_checks.py asks of a page: each function returns what it found, in an array.
({
  plots() {
    return [...document.querySelectorAll("svg.plot")].map((plot) => {
    const box = plot.getBoundingClientRect();
    return [plot.querySelector("title")?.textContent, box.left, box.top + scrollY, box.right, box.bottom + scrollY];
  });
  },

  overlapping() {
    const found = [];
    for (const plot of document.querySelectorAll("svg.plot")) {
      const outer = plot.getBoundingClientRect();
      const texts = [...plot.querySelectorAll("text")].filter((each) => each.textContent.trim());
      const boxes = texts.map((each) => each.getBoundingClientRect());
      const name = plot.querySelector("title").textContent;
      boxes.forEach((a, i) => {
        if (a.left < outer.left - 1 || a.right > outer.right + 1 || a.top < outer.top - 1 || a.bottom > outer.bottom + 1)
          found.push(`${name}: "${texts[i].textContent}" leaves the plot`);
        boxes.slice(i + 1).forEach((b, j) => {
          const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
          const up = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
          if (across > 1 && up > 2)
            found.push(`${name}: "${texts[i].textContent}" and "${texts[i + 1 + j].textContent}" overlap`);
        });
      });
    }
    return found;
  },

  faint(least) {
    const parse = (text) => (text.match(/[\d.]+/g) || []).map(Number);
    const linear = (c) => ((c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    const light = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
    const ground = (element) => {
      for (let each = element; each; each = each.parentElement) {
        const colour = parse(getComputedStyle(each).backgroundColor);
        if (colour.length === 3 || (colour.length === 4 && colour[3] > 0)) return colour;
      }
      return [255, 255, 255];
    };
    const found = new Set();
    for (const element of document.querySelectorAll("body *")) {
      if (element.closest("script, style, title, desc, defs")) continue;
      if (![...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim())) continue;
      if (element.closest('svg [aria-label], figure svg g[clip-path]')) continue;
      const style = getComputedStyle(element);
      const text = parse(element instanceof SVGElement ? style.fill : style.color);
      const [a, b] = [light(text), light(ground(element))].sort((x, y) => y - x);
      const ratio = (a + 0.05) / (b + 0.05);
      if (ratio < least) found.add(`${element.tagName} "${element.textContent.trim().slice(0, 30)}": ${ratio.toFixed(2)}`);
    }
    return [...found];
  },

  unsorted() {
    const found = [];
    const collator = new Intl.Collator("en", { numeric: true });
    const value = (cell) => cell.dataset.v === undefined ? cell.textContent.trim()
      : cell.dataset.v === "inf" ? Infinity : Number(cell.dataset.v);
    const ordered = (a, b) => typeof a !== typeof b ? 0 : typeof a === "number" ? a - b || 0 : collator.compare(a, b);
    const tables = document.querySelectorAll(".table table");
    if (!tables.length) found.push("there is no table");
    for (const table of tables) {
      const rows = () => [...table.tBodies[0].rows];
      const before = rows();
      [...table.tHead.rows[0].cells].forEach((head, place) => {
        if (!head.textContent.trim()) return;
        const name = `${table.caption.textContent}, ${head.textContent}`;
        const button = head.querySelector("button");
        if (!button) return found.push(`${name}: no button`);
        for (const wanted of ["ascending", "descending"]) {
          button.click();
          if (head.getAttribute("aria-sort") !== wanted) found.push(`${name}: aria-sort ${head.getAttribute("aria-sort")}`);
          const values = rows().map((row) => value(row.cells[place]));
          const sign = wanted === "ascending" ? 1 : -1;
          if (values.slice(1).some((after, at) => sign * ordered(values[at], after) > 0)) found.push(`${name}: not ${wanted}`);
        }
        button.click();
        if (rows().some((row, at) => row !== before[at])) found.push(`${name}: the third press does not restore the order`);
      });
    }
    return found;
  },

  // A word that some rows have and others have not, so that a filter has something to hide.
  distinctive(texts) {
    const words = texts[3].split(/[^a-z0-9]+/).filter((word) => word.length > 1);
    return words.find((word) => texts.some((text) => !text.includes(word))) ?? words[0];
  },
});
