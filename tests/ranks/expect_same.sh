# For scripts that compare results.

# expect_same ONE OTHER: both folders have the same files, byte by byte, but for run.json.
expect_same() {
  (cd "$1" && find . -type f ! -name run.json ! -name '.*' | sort) > files
  (cd "$2" && find . -type f ! -name run.json ! -name '.*' | sort) | diff files -
  test "$(wc -l < files)" -gt 10
  while read -r file; do cmp "$1/$file" "$2/$file"; done < files
}
