document.querySelectorAll("table.sortable").forEach(table => {
  table.querySelectorAll("th button").forEach((button, column) => button.addEventListener("click", () => {
    const heading = button.parentElement, descending = heading.getAttribute("aria-sort") === "ascending";
    table.querySelectorAll("th").forEach(other => other.removeAttribute("aria-sort"));
    heading.setAttribute("aria-sort", descending ? "descending" : "ascending");
    const key = row => { const cell = row.cells[column]; return "key" in cell.dataset ? Number(cell.dataset.key) : cell.textContent; };
    const order = (a, b) => typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b));
    const body = table.tBodies[0];
    [...body.rows].sort((a, b) => (descending ? -1 : 1) * order(key(a), key(b))).forEach(row => body.append(row));
  }));
});
