// Formulas of the pages, which the site's Markdown leaves as \( \) and \[ \] in elements of a class of their own.
for (const element of document.querySelectorAll(".arithmatex")) {
  const text = element.textContent.trim();
  katex.render(text.slice(2, -2), element, { displayMode: text.startsWith("\\["), throwOnError: false });
}
