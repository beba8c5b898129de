# Writes the example file NAME that the README shows: the indented lines behind the first text that says `NAME`.
#   awk -v name=weir.toml -f readme_file.awk README.md
index($0, "`" name "`") && !/^    / { found = 1 }
found && /^    / { printf "%s%s\n", blank, substr($0, 5); shown = 1; blank = ""; next }
shown && /^$/ { blank = blank "\n"; next }
shown { exit }
