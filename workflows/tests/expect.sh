# To be sourced by tests. Counts what failed in `failures`.
failures=0

# expect WHAT EXPECTED FOUND
expect() {
  if [ "$2" == "$3" ]; then
    echo "ok: $1"
  else
    echo "FAILED: $1"
    diff <(echo "$2") <(echo "$3") | sed 's/^</  expected/; s/^>/  found/; /^[0-9-]/d' || true
    failures=$((failures + 1))
  fi
}
