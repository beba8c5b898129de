#!/usr/bin/env bash
# Opens a report in headless Chromium: report.sh POST RESULTS FOLDER. Writes the page and pictures
# of it into FOLDER. Fails if the page writes to the console or requests anything, or if its sliders
# and tables do not work. If Chromium is missing, it says so and does nothing.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
post=$(realpath "$1") results=$(realpath "$2") folder=$3
mkdir -p "$folder"
cd "$folder"
if ! command -v chromium > /dev/null; then
  echo "skipped: chromium is not installed"
  exit 0
fi
profile=$scratch/profile
mkdir "$profile"
# browse PAGE OPTION...
browse() {
  timeout 120 chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --no-first-run --user-data-dir="$profile" \
    --disable-background-networking --disable-component-update --disable-sync --enable-logging=stderr "${@:2}" \
    "file://$PWD/$1" 2> browser.log
}

"$post" report "$results" -o report.html

# The page, with a script before its own that watches it, and a script after it that uses it.
watch='<script>window.seen=[];addEventListener("error",e=>seen.push(e.message));
addEventListener("securitypolicyviolation",e=>seen.push(e.blockedURI));</script>'
use='<script>
const say = (name, text) => { document.title += " " + name + "=" + text; };
document.title = "";
const film = document.querySelector(".film"), slider = film.querySelector("input");
slider.value = 0;
slider.dispatchEvent(new Event("input"));
const frames = [...film.querySelectorAll(".frame")];
say("shown", frames.map(frame => getComputedStyle(frame).display === "none" ? 0 : 1).join(""));
say("first", film.querySelector("output").textContent === frames[0].dataset.time);
say("together", [...document.querySelectorAll(".film output")].every(o => o.textContent === frames[0].dataset.time));
say("pictures", [...document.images].every(i => i.alt && i.src.startsWith("data:image/png")));
const table = document.querySelector("table.ledger"), head = table.tHead.rows[0].cells[3];
const column = () => [...table.tBodies[0].rows].map(row => Number(row.cells[3].dataset.value));
const sorted = values => values.every((v, i) => i === 0 || values[i - 1] <= v);
head.firstElementChild.click();
say("ascending", sorted(column()) && head.getAttribute("aria-sort") === "ascending");
head.firstElementChild.click();
say("descending", sorted(column().reverse()) && head.getAttribute("aria-sort") === "descending");
addEventListener("load", () => {
  say("decoded", [...document.images].every(image => image.complete && image.naturalWidth > 0));
  say("requests", performance.getEntriesByType("resource").filter(r => !r.name.startsWith("data:")).length);
  say("errors", window.seen.length);
});</script>'
while IFS= read -r line; do
  case $line in
    '<script>') printf '%s\n%s\n' "$watch" "$line" ;;
    '</body>') printf '%s\n%s\n' "$use" "$line" ;;
    *) printf '%s\n' "$line" ;;
  esac
done < report.html > watched.html
title=$(browse watched.html --virtual-time-budget=20000 --log-net-log="$profile/net.json" --dump-dom |
  sed -n 's:^<title>\(.*\)</title>.*:\1:p')
value() { sed -n "s/.* $1=\([^ ]*\).*/\1/p" <<< " $title"; }
frames=$(value shown)
expect 'the slider at its start shows the first picture alone' "1${frames:1}" "$frames"
expect 'and no other' 1 "${frames//[!1]/}"
for name in first together pictures ascending descending decoded; do expect "$name" true "$(value $name)"; done
expect 'requests of the page' 0 "$(value requests)"
expect 'errors of the page' 0 "$(value errors)"
expect 'messages in the console' 0 "$(grep -c 'CONSOLE' browser.log || true)"
# Chromium requests its own updates from Google.
expect 'addresses in the log of the network' '' "$(grep -o '"url":"[^"]*"' "$profile/net.json" |
  grep -v '"url":"\(file\|data\|chrome\|devtools\|about\):' | grep -vE '"https?://[a-z0-9.]*google(apis)?\.com/' | sort -u)"

for width in 1600 800; do
  browse report.html --window-size=$width,5200 --screenshot="light-$width.png"
  browse report.html --window-size=$width,5200 --force-dark-mode --screenshot="dark-$width.png"
done
browse report.html --no-pdf-header-footer --print-to-pdf=report.pdf
for file in light-1600.png light-800.png dark-1600.png dark-800.png report.pdf; do
  expect "$file is there" yes "$([ -s "$file" ] && echo yes)"
done
echo "The page and its pictures are in $PWD"
finish 'the report'
