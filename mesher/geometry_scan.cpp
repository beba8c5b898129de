#include "geometry_scan.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>

namespace suffuse {

namespace fs = std::filesystem;

namespace {

/// Gmsh 4.8's scanner overruns longer strings and would read their rest as commands.
constexpr std::size_t longest_string = 1000;

struct Token {
  enum class Kind { word, string, symbol, damaged };
  Kind kind;
  std::string text;
  int line;
};

bool is_word_start(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Splits a .geo text as Gmsh does: comments dropped, strings whole.
class Tokenizer {
 public:
  explicit Tokenizer(const std::string& text) : text_(text) {}

  std::vector<Token> run() {
    while (at_ < text_.size()) step();
    return std::move(tokens_);
  }

 private:
  void step() {
    const char c = text_[at_];
    if (text_.compare(at_, 2, "//") == 0) {
      advance_to(text_.find('\n', at_));
    } else if (text_.compare(at_, 2, "/*") == 0) {
      block_comment();
    } else if (c == '"' || c == '\'') {
      string(c);
    } else if (is_word_start(c)) {
      word();
    } else {
      if (std::isspace(static_cast<unsigned char>(c)) == 0) add(Token::Kind::symbol, {c});
      advance_to(at_ + 1);
    }
  }

  void block_comment() {
    const std::size_t end = text_.find("*/", at_ + 2);
    if (end == std::string::npos) add(Token::Kind::damaged, "a comment that does not end");
    advance_to(end == std::string::npos ? end : end + 2);
  }

  void string(char quote) {
    const std::size_t end = text_.find(quote, at_ + 1);
    const std::string value = text_.substr(at_ + 1, end == std::string::npos ? end : end - at_ - 1);
    if (end == std::string::npos) {
      add(Token::Kind::damaged, "a string that does not end");
    } else if (value.size() > longest_string) {
      add(Token::Kind::damaged, "a string of more than 1000 letters");
    } else {
      add(Token::Kind::string, value);
    }
    advance_to(end == std::string::npos ? end : end + 1);
  }

  void word() {
    std::size_t end = at_;
    while (end < text_.size() && is_word(text_[end])) ++end;
    add(Token::Kind::word, text_.substr(at_, end - at_));
    advance_to(end);
  }

  void add(Token::Kind kind, const std::string& text) { tokens_.push_back({kind, text, line_}); }

  void advance_to(std::size_t end) {
    end = std::min(end, text_.size());
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                         text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
    at_ = end;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::vector<Token> tokens_;
};

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& words, const std::string& word) {
  return std::ranges::find(words, word) != words.end();
}

/// Refused as commands.
constexpr std::array<std::string_view, 16> refused_words{"SystemCall",      "NonBlockingSystemCall",
                                                         "System",          "OnelabRun",
                                                         "OnelabAction",    "SendToServer",
                                                         "ExternalProcess", "Plugin",
                                                         "Print",           "Save",
                                                         "CreateDir",       "Exit",
                                                         "Abort",           "AbortOnError",
                                                         "Solver",          "Onelab"};

/// Refused inside strings as well: text that Gmsh skips is not always skipped as it should be.
constexpr std::array<std::string_view, 4> shell_words{"SystemCall", "NonBlockingSystemCall",
                                                      "OnelabRun", "ExternalProcess"};

constexpr std::array<std::string_view, 4> file_words{"Include", "Merge", "MergeWithBoundingBox",
                                                     "ShapeFromFile"};

constexpr std::array<std::string_view, 3> printing_words{"Printf", "Error", "Warning"};

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return std::tolower(c); });
  return extension;
}

std::string read_text(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  std::error_code ignored;
  if (!stream || fs::is_directory(path, ignored)) {
    throw FileError(path + ": cannot be read; check the name");
  }
  text << stream.rdbuf();
  return text.str();
}

class Scan {
 public:
  std::vector<InputProblem> run(const fs::path& path) {
    file(path);
    return std::move(problems_);
  }

 private:
  void report(const fs::path& path, int line, const std::string& found,
              const std::string& expected) {
    problems_.push_back({path.string() + ":" + std::to_string(line), "", found, expected, ""});
  }

  void file(const fs::path& path) {
    if (!visited_.insert(fs::weakly_canonical(path)).second) return;
    const std::string text = read_text(path.string());
    const std::string extension = lower_extension(path);
    if (extension == ".geo" || extension == ".opt" || extension == ".pos") {
      script(path, text);
    } else if (extension == ".msh") {
      expect_start(path, text, {"$MeshFormat", "$Comments"});
    } else if (extension == ".step" || extension == ".stp") {
      expect_start(path, text, {"ISO-10303-21"});
    } else if (extension != ".brep" && extension != ".iges" && extension != ".igs") {
      report(path, 1, "a file ending in \"" + extension + "\"",
             "a .geo, .msh, .step, .stp, .brep, .iges, .igs or .pos file");
    }
    const fs::path options = path.string() + ".opt";
    std::error_code ignored;
    if (fs::exists(options, ignored)) file(options);
  }

  /// Gmsh executes as .geo whatever it does not recognise.
  void expect_start(const fs::path& path, const std::string& text,
                    const std::vector<std::string>& starts) {
    if (std::ranges::any_of(starts, [&](const auto& start) { return text.starts_with(start); })) {
      return;
    }
    report(path, 1, "a file that does not begin with " + starts.front(),
           "a true " + lower_extension(path) + " file");
  }

  void script(const fs::path& path, const std::string& text) {
    if (text.find('\0') != std::string::npos) {
      report(path, 1, "a NUL character", "plain text");
      return;
    }
    const std::vector<Token> tokens = Tokenizer(text).run();
    for (std::size_t i = 0; i < tokens.size(); ++i) token(path, tokens, i);
  }

  void token(const fs::path& path, const std::vector<Token>& tokens, std::size_t i) {
    const Token& token = tokens[i];
    if (token.kind == Token::Kind::damaged) report(path, token.line, token.text, "valid Gmsh text");
    if (token.kind == Token::Kind::string) refuse_shell_words(path, token);
    if (token.kind != Token::Kind::word) return;
    if (contains(refused_words, token.text)) {
      report(path, token.line, token.text,
             "a geometry that runs no commands, writes no files and does not end the program");
    } else if (contains(file_words, token.text)) {
      drawn_in(path, tokens, i);
    } else if (contains(printing_words, token.text)) {
      refuse_redirection(path, tokens, i);
    }
  }

  void refuse_shell_words(const fs::path& path, const Token& token) {
    for (std::string_view word : shell_words) {
      if (token.text.find(word) == std::string::npos) continue;
      report(path, token.line, "a string with " + std::string(word),
             "a geometry that runs no commands");
      return;
    }
  }

  /// `Printf(...) > "file"` writes.
  void refuse_redirection(const fs::path& path, const std::vector<Token>& tokens, std::size_t i) {
    int depth = 0;
    for (++i; i < tokens.size() && tokens[i].text != ";"; ++i) {
      if (tokens[i].kind != Token::Kind::symbol) continue;
      const char symbol = tokens[i].text.front();
      if (symbol == '(' || symbol == '[') ++depth;
      if (symbol == ')' || symbol == ']') --depth;
      if (symbol == '>' && depth <= 0) {
        report(path, tokens[i].line, "output to a file", "a geometry that writes no files");
        return;
      }
    }
  }

  /// The name must be one plain string, or what Gmsh opens could not be told beforehand.
  void drawn_in(const fs::path& path, const std::vector<Token>& tokens, std::size_t i) {
    const Token& command = tokens[i];
    const bool in_brackets = command.text == "ShapeFromFile";
    const std::size_t name = in_brackets ? i + 2 : i + 1;
    const bool plain = name + 1 < tokens.size() && tokens[name].kind == Token::Kind::string &&
                       tokens[name + 1].text == (in_brackets ? ")" : ";");
    if (!plain) {
      report(path, command.line, command.text + " with a computed name",
             "one file name between quotes");
      return;
    }
    const fs::path target = path.parent_path() / tokens[name].text;
    std::error_code ignored;
    if (!fs::is_regular_file(target, ignored)) {
      report(path, command.line, command.text + " \"" + tokens[name].text + "\"",
             "a file that exists");
      return;
    }
    file(target);
  }

  std::set<fs::path> visited_;
  std::vector<InputProblem> problems_;
};

}  // namespace

std::vector<InputProblem> scan_geometry_file(const std::string& path) {
  return Scan().run(path);
}

}  // namespace suffuse
