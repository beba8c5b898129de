#pragma once

/// Pieces of an HTML page.

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace suffuse::html {

/// Text escaped for a page: no character of it is taken for markup, even in attributes.
std::string escaped(const std::string& text);

/// `<NAME>text</NAME>`, with the text escaped.
std::string element(const std::string& name, const std::string& text);

/// `<ul>` of texts.
std::string list(const std::vector<std::string>& texts);

/// A text that the reader can open and close.
std::string folded(const std::string& summary, const std::string& inner_html);

/// A file within the page: its bytes as a `data:` address. The suffix, .png or .svg, gives the
/// type. Throws FileError.
std::string data_address(const std::string& path);

/// A cell of a table.
struct Cell {
  std::string text;
  /// The column is sorted by this exact value; unset: by the text.
  std::optional<double> value{};
};

/// A number in six digits.
Cell cell(double value);
/// A cell that shows `text` and is sorted by `value`.
Cell cell(double value, const std::string& text);
Cell cell(const std::string& text);

/// A table whose rows the reader can sort.
struct Table {
  std::string name;  ///< name of the HTML element, by which programs find it
  std::vector<std::string> heads;
  std::vector<std::vector<Cell>> rows;
  std::set<std::size_t> exceeded{};  ///< numbers of the rows whose limit is exceeded: bold and red

  [[nodiscard]] std::string html() const;
};

}  // namespace suffuse::html
