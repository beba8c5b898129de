# To be sourced. find_file VARIABLE FOLDER: the absolute path of the file that make's variable
# names, relative to FOLDER, where make was called, or to this folder.
find_file() {
  local value=${!1:-} file
  if [ -z "$value" ]; then
    echo "$1: got nothing; expected a file: make -C workflows TARGET $1=FILE" >&2
    return 2
  fi
  for file in "$2/$value" "$value"; do
    case $value in /*) file=$value ;; esac
    if [ -f "$file" ]; then realpath -- "$file"; return; fi
  done
  echo "$1: got '$value'; there is no such file, seen from $2" >&2
  return 2
}
