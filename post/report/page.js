"use strict";

// The sliders of a run move together: all of its fields are shown at the same time.
for (const run of document.querySelectorAll(".run")) {
  const films = [...run.querySelectorAll(".film")].filter(film => film.querySelector("input"));
  const show = (film, index) => {
    const frames = [...film.querySelectorAll(".frame")];
    frames.forEach((frame, k) => frame.classList.toggle("shown", k === index));
    const slider = film.querySelector("input");
    const time = frames[index].dataset.time;
    slider.value = index;
    slider.setAttribute("aria-valuetext", time);
    film.querySelector("output").textContent = time;
  };
  for (const film of films) {
    const slider = film.querySelector("input");
    slider.addEventListener("input", () => films.forEach(other => show(other, Number(slider.value))));
  }
}

// A click on the head of a column sorts by it, another one the other way round. Cells without a number come last.
for (const table of document.querySelectorAll("table")) {
  const heads = [...table.tHead.rows[0].cells];
  const number = cell => cell.dataset.value === undefined ? NaN : Number(cell.dataset.value);
  const compare = (a, b) => {
    const [x, y] = [number(a), number(b)];
    if (Number.isNaN(x) && Number.isNaN(y)) return a.textContent.localeCompare(b.textContent);
    return x - y;
  };
  heads.forEach((head, column) => head.firstElementChild.addEventListener("click", () => {
    const ascending = head.getAttribute("aria-sort") !== "ascending";
    heads.forEach(other => other.removeAttribute("aria-sort"));
    head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
    const has_numbers = row => !Number.isNaN(number(row.cells[column]));
    const rows = [...table.tBodies[0].rows];
    const numbered = rows.some(has_numbers);
    rows.sort((a, b) => {
      if (numbered && has_numbers(a) !== has_numbers(b)) return has_numbers(a) ? -1 : 1;
      const order = compare(a.cells[column], b.cells[column]);
      return ascending ? order : -order;
    });
    table.tBodies[0].append(...rows);
  }));
}
