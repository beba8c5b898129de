#include "mutator.hpp"

#include <array>
#include <sstream>
#include <vector>

namespace suffuse::fuzz {
namespace {

using Lines = std::vector<std::string>;

Lines lines_of(const std::string& text) {
  Lines lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string text_of(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

template <class List>
std::string one_of(const List& list, const Draw& draw) {
  if (std::empty(list)) return "";
  return std::string(*(std::begin(list) + static_cast<std::ptrdiff_t>(draw(std::size(list)))));
}

std::string number(const Draw& draw) {
  static const Lines numbers{"0",
                             "1",
                             "2",
                             "3",
                             "-1",
                             "4",
                             "8",
                             "24",
                             "0.5",
                             "0.3333333333333333",
                             "nan",
                             "inf",
                             "-inf",
                             "1e300",
                             "-1e300",
                             "1e-300",
                             "5e-324",
                             "1e-12",
                             "255",
                             "65536",
                             "2147483647",
                             "2147483648",
                             "4294967295",
                             "4294967296",
                             "9223372036854775807",
                             "-9223372036854775808"};
  if (draw(3) == 0) return std::to_string(draw(64));
  return one_of(numbers, draw);
}

std::string type(const Draw& draw) {
  static const Lines types{"i8",     "u8",   "i32",       "u32",   "i64",      "u64",
                           "f32",    "f64",  "text",      "vtext", "compound", "array",
                           "opaque", "enum", "reference", "big",   "bits",     "wide_integer"};
  return one_of(types, draw);
}

std::string extents(const Draw& draw) {
  std::string all;
  for (std::size_t i = draw(3) + 1; i > 0; --i) {
    all += " " + (draw(2) == 0 ? std::to_string(draw(40)) : number(draw));
  }
  return all;
}

std::string text(const Vocabulary& words, const Draw& draw) {
  switch (draw(5)) {
    case 0:
      return one_of(words.objects, draw).substr(1);
    case 1:
      return "specimen";
    case 2:
      return "";
    case 3:
      return number(draw);
    default:
      return std::string(draw(80), 'x') + "\x1b[31m\xff";
  }
}

std::string json_value(const Draw& draw) {
  static const Lines values{"null", "true", "[]", "{}",      "\"\"",   "\"x\"", "[1,2]",
                            "[[]]", "1e99", "-1", "[\"a\"]", "remove", "0.5",   "3"};
  return draw(4) == 0 ? number(draw) : one_of(values, draw);
}

/// An edit to an HDF5 file.
std::string drawn_hdf5_edit(const Vocabulary& words, const Draw& draw) {
  const std::string object = one_of(words.objects, draw);
  const std::string other = one_of(words.objects, draw);
  const auto value = [&] { return draw(3) == 0 ? text(words, draw) : number(draw); };
  static const Lines layouts{"chunked", "deflate", "contiguous", "external", "virtual"};
  static const Lines links{"rename", "copy", "hard", "soft", "outside"};
  static const Lines removals{"remove", "group", "type-object"};
  switch (draw(9)) {
    case 0:
    case 1:
      return "value " + object + " " + std::to_string(draw(100)) + " " + value();
    case 2:
      return "type " + object + " " + type(draw);
    case 3:
      return "shape " + object + extents(draw);
    case 4:
      return "claim " + object + " " + one_of(layouts, draw) + extents(draw);
    case 5:
      return "text " + object + " " + text(words, draw);
    case 6:
      return one_of(removals, draw) + " " + object;
    case 7:
      return one_of(links, draw) + " " + object + " " + other;
    default:
      if (draw(4) == 0) return "no-attribute " + one_of(words.attributes, draw);
      return "attribute " + one_of(words.attributes, draw) + " " + type(draw) + " " + value();
  }
}

/// An edit to the bytes of a file.
std::string drawn_raw_edit(const Draw& draw) {
  const std::string at = std::to_string(draw(30000));
  switch (draw(5)) {
    case 0:
      return "cut " + at;
    case 1:
      return "grow " + at;
    default:
      return "byte " + at + " " + std::to_string(draw(256));
  }
}

/// An edit to a file of a results folder that is not HDF5.
std::string drawn_folder_edit(const Vocabulary& words, const Draw& draw) {
  switch (draw(6)) {
    case 0:
      return draw(2) == 0 ? "delete" : "folder";
    case 1:
      return "line " + std::to_string(draw(130)) + " " + number(draw) + "," + number(draw);
    default:
      return "json " + one_of(words.pointers, draw) + " " + json_value(draw);
  }
}

}  // namespace

std::string drawn_edit(const Vocabulary& words, const Draw& draw) {
  const bool has_files = !words.files.empty();
  if (draw(20) == 0) return "seed " + one_of(words.seeds, draw);
  if (has_files && draw(2) == 0) {
    return draw(2) == 0 ? "in " + one_of(words.files, draw) : drawn_folder_edit(words, draw);
  }
  if (draw(3) == 0) return "set " + one_of(words.settings, draw);
  return draw(8) == 0 ? drawn_raw_edit(draw) : drawn_hdf5_edit(words, draw);
}

std::string drawn_scene_line(const Vocabulary& words, const Draw& draw) {
  const std::string setting = one_of(words.settings, draw);
  if (draw(2) == 0) return "#set " + setting;
  const std::size_t equals = setting.find('=');
  const std::size_t dot = setting.rfind('.', equals);
  const std::string table = dot == std::string::npos ? "" : setting.substr(0, dot);
  switch (draw(3)) {
    case 0:
      return setting;
    case 1:
      return table.ends_with(']') ? "[[" + table.substr(0, table.find('[')) + "]]"
                                  : "[" + table + "]";
    default:
      return dot == std::string::npos ? setting : setting.substr(dot + 1);
  }
}

std::string drawn_geometry_line(const Vocabulary& words, const Draw& draw) {
  const std::string line = one_of(words.settings, draw);
  switch (draw(12)) {
    case 0:
      return "/* " + line + (draw(2) == 0 ? " */" : "");
    case 1:
      return "If(" + number(draw) + ")\n" + line + "\nEndIf";
    case 2:
      return "Macro m\n" + line + "\nReturn\nCall m;";
    case 3:
      return "For i In {1:" + std::to_string(draw(4)) + "}\n" + line + "\nEndFor";
    case 4:
      return "\"" + line;
    default:
      return line;
  }
}

std::string changed(const std::string& input, const Draw& draw,
                    const std::function<std::string()>& new_line) {
  Lines lines = lines_of(input);
  for (std::size_t times = 1 + draw(3); times > 0; --times) {
    if (lines.empty() || draw(3) == 0) {
      const auto at = static_cast<std::ptrdiff_t>(draw(lines.size() + 1));
      lines.insert(lines.begin() + at, new_line());
      continue;
    }
    std::string& line = lines[draw(lines.size())];
    switch (draw(5)) {
      case 0:
        lines.erase(lines.begin() + (&line - lines.data()));
        break;
      case 1:
        std::swap(line, lines[draw(lines.size())]);
        break;
      case 2: {
        // Replaces the last word.
        const std::size_t space = line.find_last_of(" =");
        if (space != std::string::npos) line = line.substr(0, space + 1) + number(draw);
        break;
      }
      case 3:
        lines.push_back(std::string(line));
        break;
      default:
        line = new_line();
    }
  }
  return text_of(lines);
}

std::string crossed(const std::string& a, const std::string& b, const Draw& draw) {
  Lines lines = lines_of(a);
  const Lines others = lines_of(b);
  lines.resize(draw(lines.size() + 1));
  if (!others.empty()) {
    lines.insert(lines.end(), others.begin() + static_cast<std::ptrdiff_t>(draw(others.size())),
                 others.end());
  }
  return text_of(lines);
}

}  // namespace suffuse::fuzz
