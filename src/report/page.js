const words = JSON.parse(document.getElementById("words")?.textContent ?? "[]");
const marks = { "✓ passed": "pass", "right": "pass", "✗ failed": "fail", "wrong": "fail" };
// On narrow screens a row is a card, and each cell says what it is.
const label = table => {
  const headings = [...table.querySelectorAll("th")].map(heading => heading.textContent);
  [...table.tBodies[0].rows].forEach(row => [...row.cells].forEach((cell, n) => cell.dataset.label = headings[n]));
  table.classList.add("stack");
};
const unpack = details => {
  const source = details.querySelector("script");
  if (!source || !details.open) return;
  const { h, r } = JSON.parse(source.textContent), table = document.createElement("table"), frame = document.createElement("div");
  const head = table.createTHead().insertRow(), body = table.createTBody();
  h.forEach(text => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = text;
    head.append(document.createElement("th"));
    head.lastChild.append(button);
  });
  r.forEach(cells => {
    const row = body.insertRow();
    cells.forEach(cell => {
      const text = typeof cell === "number" ? words[cell] : cell, place = row.insertCell();
      place.textContent = text;
      if (marks[text]) place.className = marks[text];
    });
  });
  table.className = "sortable";
  frame.className = "scroll";
  frame.append(table);
  source.replaceWith(frame);
  label(table);
};
document.querySelectorAll("table.sortable").forEach(label);
document.querySelectorAll("details.packed").forEach(details => {
  details.addEventListener("toggle", () => unpack(details));
  unpack(details);
});
document.addEventListener("click", event => {
  const button = event.target.closest("table.sortable th button");
  if (!button) return;
  const heading = button.parentElement, table = heading.closest("table"), column = heading.cellIndex;
  const descending = heading.getAttribute("aria-sort") === "ascending";
  table.querySelectorAll("th").forEach(other => other.removeAttribute("aria-sort"));
  heading.setAttribute("aria-sort", descending ? "descending" : "ascending");
  const key = row => {
    const cell = row.cells[column], text = cell.textContent, number = "key" in cell.dataset ? Number(cell.dataset.key) : Number(text);
    return text === "" || Number.isNaN(number) ? text : number;
  };
  const order = (a, b) => typeof a !== typeof b ? (typeof a === "number" ? -1 : 1) : typeof a === "number" ? a - b : a.localeCompare(b);
  const body = table.tBodies[0];
  [...body.rows].sort((a, b) => (descending ? -1 : 1) * order(key(a), key(b))).forEach(row => body.append(row));
});
