#!/usr/bin/env python3
"""Builds the site of the documents with MkDocs: build.py OUT. Writes OUT/site/, from copies in OUT/site.pages/.

All pages that README.md and docs/README.md lead to, and all files that these pages refer to, are copied in their
places, so that links hold. The navigation has the order in which docs/README.md names the pages. Warnings of MkDocs,
such as a link that leads nowhere, are errors.
"""
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))
from check_documents import links  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent.parent
INDEX = Path("docs/README.md")
KATEX = Path("/usr/share/javascript/katex")
ROOMS = ["use", "reference", "theory", "evidence", "develop"]


def linked(page):
    """Files that a page refers to, as paths relative to the root, in its order."""
    for _, target in links((ROOT / page).read_text()):
        file = target.partition("#")[0]
        path = (ROOT / page.parent / file).resolve()
        if file and path.is_file() and path.is_relative_to(ROOT):
            yield path.relative_to(ROOT)


def gathered():
    """All pages and files of the site."""
    found, waiting = {}, [Path("README.md"), INDEX]
    while waiting:
        page = waiting.pop()
        if page in found:
            continue
        found[page] = None
        if page.suffix == ".md":
            waiting += linked(page)
    return found


def title(page):
    """The first heading of a page, without marks."""
    heading = re.search(r"^# (.*)$", (ROOT / page).read_text(), re.M)
    return heading[1].replace("`", "") if heading else page.stem


def navigation(pages):
    """Lines of YAML."""
    entry = lambda page: f"      - {json.dumps(title(page), ensure_ascii=False)}: {page}"
    yield "nav:"
    yield "  - Suffuse: README.md"
    yield f"  - Index: {INDEX}"
    # The paths of readers name pages before the tables of the rooms do.
    order = [*dict.fromkeys(page for page in reversed([*linked(INDEX)]) if page.suffix == ".md")][::-1]
    rooms = {room.capitalize(): [page for page in order if page.parts[:2] == ("docs", room)] for room in ROOMS}
    rooms["Examples"] = [page for page in pages if page.parts[:2] == ("workflows", "examples") and page.suffix == ".md"]
    for room, entries in rooms.items():
        yield f"  - {room}:"
        yield from map(entry, entries)
    yield "  - Changes: CHANGELOG.md"


def main():
    out = Path(sys.argv[1]).resolve()
    pages = out / "site.pages"
    shutil.rmtree(pages, ignore_errors=True)
    found = gathered()
    for file in found:
        (pages / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / file, pages / file)
    shutil.copytree(KATEX, pages / "site/katex")  # what its links lead to, too
    for name in ("formulas.js", "site.css"):
        shutil.copyfile(ROOT / "workflows/site" / name, pages / "site" / name)
    config = out / "site.yml"
    config.write_text("\n".join([f"INHERIT: {os.path.relpath(ROOT / 'mkdocs.yml', out)}", f"docs_dir: {pages}",
                                 f"site_dir: {out / 'site'}", *navigation(sorted(found))]) + "\n")
    done = subprocess.run(["mkdocs", "build", "--strict", "--config-file", str(config)], check=False, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode:
        print("\n".join(line for line in done.stdout.splitlines() if re.search("WARNING|ERROR|Abort", line)))
    else:
        print(f"The site is {out / 'site'}; to search in it: python3 -m http.server --directory {out / 'site'}")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
