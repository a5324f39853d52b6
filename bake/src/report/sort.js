// Tables that are sorted by their headings. Numbers go by `data-value`, the rest by its text; what has neither comes last,
// whichever way the others go. Equals keep their order.
"use strict";
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const headings = [...table.tHead.rows[0].cells];
  const key = (row, column) => {
    const cell = row.cells[column];
    if (cell.dataset.value !== undefined) return Number(cell.dataset.value);
    return cell.classList.contains("number") ? null : cell.textContent.trim();
  };
  const order = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en", { numeric: true }));
  const sort = (column, falls) => {
    const rows = [...body.rows].map((row) => ({ row, key: key(row, column) }));
    const known = rows.filter((entry) => entry.key !== null && entry.key !== "");
    const unknown = rows.filter((entry) => entry.key === null || entry.key === "");
    known.sort((a, b) => (falls ? order(b.key, a.key) : order(a.key, b.key)));
    body.append(...known.concat(unknown).map((entry) => entry.row));
    headings.forEach((heading, index) => {
      if (index === column) heading.setAttribute("aria-sort", falls ? "descending" : "ascending");
      else heading.removeAttribute("aria-sort");
    });
  };
  headings.forEach((heading, column) => {
    const button = document.createElement("button");
    button.type = "button";
    if (heading.firstChild) button.append(heading.firstChild);
    heading.prepend(button);
    button.addEventListener("click", () => sort(column, heading.getAttribute("aria-sort") === "ascending"));
  });
}
