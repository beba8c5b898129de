#!/usr/bin/env python3
"""Links, lengths and the index of the documents. check_documents.py [ROOT]

Each link of a page leads to a file that exists, and each anchor to a heading or a mark of that file. Each page of docs/
is named in docs/README.md. README.md and the page for contributors are not longer than MOST_WORDS says, counted as
`wc -w` does. For docs/ the words count that somebody wrote: not the scene reference and the tables between marks, which are
generated, and not the bars of tables. Prints each problem, and both counts of docs/; exit code 1 if there is any problem.
"""
import re
import sys
from pathlib import Path

MOST_WORDS = {"README.md": 600, "docs/develop/contributing.md": 1300, "docs/": 50000}
GENERATED = "docs/reference/scene-reference.md"
INDEX = "docs/README.md"
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)(?:\s+\"[^\"]*\")?\)|(?:src|href)=\"([^\"]+)\"")


def pages(root):
    """The documents of the project, as paths relative to its root."""
    # Others are in folders of builds and of what the workflows make.
    folders = ["docs", "tests", "workflows", "changes"]
    found = [path for path in root.glob("*.md")]
    for folder in folders:
        found += [path for path in (root / folder).rglob("*.md") if "out" not in path.relative_to(root).parts]
    return sorted(path.relative_to(root) for path in found)


def without_code(text):
    """The text with blocks and spans of code blank; headings keep their words."""
    text = re.sub(r"^(```|~~~).*?^\1", lambda match: "\n" * match[0].count("\n"), text, flags=re.S | re.M)
    return re.sub(r"^(?: {4}|\t).*$", "", text, flags=re.M)


def slug(heading):
    """The anchor that GitHub, and the site, give to a heading."""
    heading = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    heading = re.sub(r"<[^>]*>", "", heading)
    heading = re.sub(r"[^\w\- ]", "", heading.strip().lower())
    return heading.replace(" ", "-")


def anchors(path):
    """All anchors of a page."""
    text = without_code(path.read_text())
    found = set(re.findall(r"(?:id|name)=\"([^\"]+)\"", text))
    for heading in re.findall(r"^#{1,6}[ \t]+(.*?)[ \t]*#*$", text, re.M):
        name, number = slug(heading), 0
        while (name if number == 0 else f"{name}-{number}") in found:
            number += 1
        found.add(name if number == 0 else f"{name}-{number}")
    return found


def links(text):
    """Targets of the links of a page, with their lines."""
    text = without_code(text)
    text = re.sub(r"`[^`\n]*`", lambda match: " " * len(match[0]), text)
    for match in LINK.finditer(text):
        target = match[1] or match[2]
        if not re.match(r"[a-z]+:", target):
            yield text.count("\n", 0, match.start()) + 1, target


def link_problems(root, page, known):
    """Links of one page that lead nowhere."""
    for line, target in links((root / page).read_text()):
        file, _, anchor = target.partition("#")
        path = (root / page.parent / file).resolve() if file else root / page
        if not path.exists():
            yield f"{page}:{line}: there is no {target}"
        elif anchor and path.suffix == ".md":
            if path not in known:
                known[path] = anchors(path)
            if anchor not in known[path]:
                yield f"{page}:{line}: {target} has no such heading"


def written(text):
    """Words of a page that somebody wrote."""
    text = re.sub(r"<!-- (\w+): .*?<!-- end of \1 -->", "", text, flags=re.S)
    return sum(1 for word in text.split() if re.search(r"\w", word))


def word_counts(root, documents):
    """Words of each page, of docs/ as they were written, and of docs/ by `wc -w`."""
    texts = {str(page): (root / page).read_text() for page in documents}
    counts = {page: len(text.split()) for page, text in texts.items()}
    below = [page for page in texts if page.startswith("docs/") and page != GENERATED]
    return counts | {"docs/": sum(written(texts[page]) for page in below)}, sum(counts[page] for page in below)


def word_problems(counts):
    """Pages, and the whole, that are too long."""
    for name, most in MOST_WORDS.items():
        if counts.get(name, 0) > most:
            yield f"{name}: has {counts[name]} words; expected at most {most}"


def index_problems(root, documents):
    """Pages of docs/ that the index does not name."""
    named = {(root / INDEX).parent.joinpath(target.partition("#")[0]).resolve()
             for _, target in links((root / INDEX).read_text())}
    for page in documents:
        if page.parts[0] == "docs" and str(page) != INDEX and (root / page).resolve() not in named:
            yield f"{page}: is not in {INDEX}"


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    documents, known = pages(root), {}
    problems = [problem for page in documents for problem in link_problems(root, page, known)]
    counts, all_words = word_counts(root, documents)
    problems += [*word_problems(counts), *index_problems(root, documents)]
    print("\n".join(problems + [f"check_documents: {len(documents)} pages, {counts['docs/']} words written below docs/ "
                                f"({all_words} by wc -w), {len(problems)} problems"]))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
