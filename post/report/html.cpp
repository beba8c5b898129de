#include "report/html.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>

#include "common/errors.hpp"
#include "files/number_text.hpp"

namespace suffuse::html {
namespace {

std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(4 * (bytes.size() / 3 + 1));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_there = i + k < bytes.size();
      group = group << 8U | (is_there ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    const std::size_t filled = std::min<std::size_t>(bytes.size() - i, 3) + 1;
    for (std::size_t k = 0; k < 4; ++k) {
      text += k < filled ? digits[group >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return text;
}

std::string cell_html(const Cell& cell) {
  if (cell.text == "-") return "<td class=\"empty\">-</td>";
  if (!cell.value) return "<td>" + escaped(cell.text) + "</td>";
  return "<td class=\"number\" data-value=\"" + number_text(*cell.value) + "\">" +
         escaped(cell.text) + "</td>";
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string element(const std::string& name, const std::string& text) {
  return "<" + name + ">" + escaped(text) + "</" + name + ">\n";
}

std::string list(const std::vector<std::string>& texts) {
  std::string result = "<ul>\n";
  for (const std::string& text : texts) result += element("li", text);
  return result + "</ul>\n";
}

std::string folded(const std::string& summary, const std::string& inner_html) {
  return "<details>" + element("summary", summary) + inner_html + "</details>\n";
}

std::string data_address(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in.is_open()) throw FileError(path + ": cannot be read");
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  return "data:image/png;base64," + base64(bytes);
}

Cell cell(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return {text, value};
}

Cell cell(double value, const std::string& text) {
  return {text, value};
}

Cell cell(const std::string& text) {
  return {text};
}

std::string Table::html() const {
  std::string result = "<div class=\"table\"><table class=\"" + escaped(name) + "\">\n<thead><tr>";
  for (const std::string& head : heads) {
    result += "<th scope=\"col\"><button type=\"button\">" + escaped(head) + "</button></th>";
  }
  result += "</tr></thead>\n<tbody>\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    result += exceeded.contains(r) ? "<tr class=\"exceeded\">" : "<tr>";
    for (const Cell& cell : rows[r]) result += cell_html(cell);
    result += "</tr>\n";
  }
  return result + "</tbody></table></div>\n";
}

}  // namespace suffuse::html
