/// The report: numbers are those of the tables, text is not read as markup, no other file is
/// needed.

#include "report/report.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <regex>

#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "post/run_programs.hpp"
#include "post/synthetic_results.hpp"
#include "report/html.hpp"
#include "report/report_pictures.hpp"
#include "report/run_section.hpp"

namespace suffuse {
namespace report_test {

using testing::file_text;
using testing::ScratchFolder;
using testing::write_synthetic_results;

/// A cell of a table of the page.
struct PageCell {
  std::string text;
  std::optional<double> value;
};
using PageRows = std::vector<std::vector<PageCell>>;

std::vector<std::smatch> matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  return {std::sregex_iterator(text.begin(), text.end(), expression), std::sregex_iterator()};
}

/// The rows of the table of this class; none where the page has no such table.
PageRows table_of(const std::string& page, const std::string& name) {
  const auto start = page.find("<table class=\"" + name + "\">");
  if (start == std::string::npos) return {};
  const auto body = page.find("<tbody>", start);
  const std::string table = page.substr(body, page.find("</tbody>", start) - body);
  PageRows rows;
  for (const auto& row : matches(table, "<tr[^>]*>(.*)</tr>")) {
    auto& cells = rows.emplace_back();
    const std::string text = row[1];
    for (const auto& cell : matches(
             text, "<td(?: class=\"(?:empty|number\" data-value=\"([^\"]*))\")?>([^<]*)</td>")) {
      cells.push_back({cell[2], parse_number(cell[1].str())});
    }
  }
  return rows;
}

std::string six_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// Expects that the cell has the exact number and shows six digits of it.
void expect_number(const PageCell& cell, double value) {
  ASSERT_TRUE(cell.value.has_value()) << cell.text;
  EXPECT_EQ(*cell.value, value);
  EXPECT_EQ(cell.text, six_digits(value));
}

/// A run whose name looks like markup, and its report.
class Report : public ::testing::Test {
 protected:
  Report() {
    write_synthetic_results(folder, "<script>alert('1')</script> & co");
    page = report_html({ResultsReader(folder)});
  }
  void expect_ledger() const;
  void expect_boundaries() const;
  void expect_history() const;
  void expect_no_address() const;
  void expect_texts_of_pictures() const;
  void expect_slider() const;
  void expect_no_markup_in_text() const;
  void expect_commands() const;

  const ScratchFolder scratch;
  const std::string folder = scratch / "run.results";
  std::string page;
};

void Report::expect_ledger() const {
  const Table ledger = read_table(folder + "/ledger.csv");
  const auto last = [&](const char* name) { return ledger.column(name).back(); };
  const PageRows rows = table_of(page, "ledger");
  ASSERT_EQ(rows.size(), 2U);
  ASSERT_EQ(rows[1].size(), 10U);
  EXPECT_EQ(rows[0][1].text, "water");
  expect_number(rows[0][2], ledger.column("water").front());
  expect_number(rows[0][3], last("water_in"));
  expect_number(rows[0][4], last("water_out"));
  expect_number(rows[0][5], last("water"));
  EXPECT_EQ(rows[1][1].text, "grains");
  expect_number(rows[1][3], last("fines_in"));
  expect_number(rows[1][4], last("fines_out"));
  expect_number(rows[1][5], last("solid") + last("fines"));
  expect_number(rows[1][6], last("eroded"));
  expect_number(rows[1][7], last("deposited"));
}

void Report::expect_boundaries() const {
  const auto boundaries = read_tables(folder + "/boundaries.csv", "boundary");
  const PageRows rows = table_of(page, "boundaries");
  ASSERT_EQ(rows.size(), boundaries.size());
  for (std::size_t b = 0; b < rows.size(); ++b) {
    const Table& table = boundaries[b].table;
    EXPECT_EQ(rows[b][0].text, boundaries[b].name);
    // Without level and bounds, which these runs do not have.
    constexpr std::size_t told = 8;
    ASSERT_EQ(table.names[told], "level");
    ASSERT_EQ(rows[b].size(), told);
    for (std::size_t k = 1; k < told; ++k) {
      expect_number(rows[b][k], table.columns[k].back());
    }
  }
}

void Report::expect_history() const {
  const Table history = read_table(folder + "/history.csv");
  const PageRows rows = table_of(page, "history");
  ASSERT_EQ(rows.size(), history.names.size());
  EXPECT_EQ(rows[2][0].text, "porosity_mean [-]");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& values = history.columns[k];
    ASSERT_EQ(rows[k].size(), 5U);
    expect_number(rows[k][1], values.front());
    expect_number(rows[k][2], values.back());
    expect_number(rows[k][3], *std::ranges::min_element(values));
    expect_number(rows[k][4], *std::ranges::max_element(values));
  }
}

void Report::expect_no_address() const {
  for (const auto& address : matches(page, "(?:src|href)=\"([^\"]{0,6})")) {
    const std::string start = address[1];
    EXPECT_TRUE(start.starts_with("data:") || start.starts_with("#")) << start;
  }
  for (const char* other : {"http:", "https:", "url(", "@import"}) {
    EXPECT_EQ(page.find(other), std::string::npos) << other;
  }
}

void Report::expect_texts_of_pictures() const {
  const auto pictures = matches(page, "<img[^>]{0,80}");
  EXPECT_GE(pictures.size(), 5U);
  for (const auto& picture : pictures) {
    EXPECT_NE(picture.str().find("alt=\""), std::string::npos) << picture.str();
  }
}

void Report::expect_slider() const {
  EXPECT_EQ(matches(page, "data-time=\"").size(), 3U);  // the change of porosity
  EXPECT_NE(page.find("type=\"range\" min=\"0\" max=\"2\" value=\"2\""), std::string::npos);
  EXPECT_EQ(matches(page, "class=\"frame last shown\"").size(), 1U);
  EXPECT_NE(page.find("Safety against heave; where water does not rise it has the colour of the "
                      "largest: these results do not"),
            std::string::npos);
}

void Report::expect_no_markup_in_text() const {
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_NE(page.find("<h1>&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt; &amp; co</h1>"),
            std::string::npos);
  EXPECT_EQ(matches(page, "<script").size(), 1U);
}

void Report::expect_commands() const {
  const std::string scene = "'<script>alert('\\''1'\\'')</script> & co.toml'";
  EXPECT_NE(page.find("<li>no gravity</li>"), std::string::npos);
  EXPECT_NE(page.find("<li>mass scaling 1e4 is large</li>"), std::string::npos);
  EXPECT_NE(page.find("The solver gave one warning."), std::string::npos);
  EXPECT_NE(page.find(html::escaped("suffuse-mesher " + scene + " -o run.case.h5\n") +
                      "suffuse-solver run.case.h5 -o run.results\n"
                      "suffuse-post report run.results -o run.html\n"),
            std::string::npos);
  EXPECT_NE(page.find("porosity = 0.3"), std::string::npos);  // of the scene
}

// Each of these tests makes the report anew.
TEST_F(Report, CellsAreThoseOfTheTables) {
  expect_ledger();
  expect_boundaries();
  expect_history();
}

TEST_F(Report, NeedsNothingElseAndSaysWhatItShows) {
  expect_no_address();
  expect_texts_of_pictures();
  expect_slider();
  expect_no_markup_in_text();
  expect_commands();
}

/// These results have no gradients; a table of the user's stands on the first page.
TEST_F(Report, FirstPageSaysWhatItLacksAndShowsTables) {
  EXPECT_NE(page.find("The checks of standards could not be made: these results have no hydraulic "
                      "gradient."),
            std::string::npos);
  std::ofstream(scratch / "factors.csv")
      << "t [s],factor [-],why\n0,1.25,\n10,,\"fails, at once\"\n";
  const std::string with_table = report_html({ResultsReader(folder)}, {scratch / "factors.csv"});
  const PageRows rows = table_of(with_table, "added");
  ASSERT_EQ(rows.size(), 2U);
  expect_number(rows[0][1], 1.25);
  EXPECT_EQ(rows[1][1].text, "-");
  EXPECT_EQ(rows[1][2].text, "fails, at once");
  std::ofstream(scratch / "short.csv") << "a,b\n1\n";
  EXPECT_THROW(report_html({ResultsReader(folder)}, {scratch / "short.csv"}), InputError);
}

TEST_F(Report, TellsWhatItWorksOn) {
  std::vector<std::string> parts;
  report_html({ResultsReader(folder)}, {}, [&](const std::string& part) { parts.push_back(part); });
  const auto place = [&](const std::string& part) {
    return std::ranges::find(parts, part) - parts.begin();
  };
  EXPECT_EQ(place("numbers and checks"), 0);
  EXPECT_LT(place("curves of mean porosity"), place("sketch of the model"));
  EXPECT_LT(place("sketch of the model"), place("pictures of head, 3 times"));
  EXPECT_LT(place("pictures of the change of porosity, 3 times"), std::ssize(parts));
}

TEST_F(Report, IsWrittenWholeOrNotAtAll) {
  const std::string path = scratch / "report.html";
  write_report({ResultsReader(folder)}, path);
  EXPECT_EQ(file_text(path), page);
  EXPECT_THROW(write_report({ResultsReader(folder)}, scratch / "none/report.html"), FileError);
}

TEST(ReportOfRuns, HasCurvesOfAllAndARowForEach) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "a.results", "slow", 1e-3);
  write_synthetic_results(scratch / "b.results", "fast", 2e-3);
  testing::double_point::write_results(scratch / "c.results");
  const std::string page =
      report_html({ResultsReader(scratch / "a.results"), ResultsReader(scratch / "b.results"),
                   ResultsReader(scratch / "c.results")});
  const PageRows runs = table_of(page, "runs");
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[1][0].text, "fast, single-point");
  EXPECT_EQ(runs[2][0].text, "two-phase, double-point");
  expect_number(runs[2][2], 100.0);
  EXPECT_EQ(matches(page, "<section class=\"run\"").size(), 3U);
  EXPECT_EQ(matches(page, "Mean porosity[^\"]* against time").size(), 1U);
}

TEST(ReportOfRuns, OfARunThatHasNothingYet) {
  const ScratchFolder scratch;
  const Case<2> c = testing::unit_square_case();
  ResultsWriter<2> writer(scratch / "new.results", c);
  RunInfo info;
  info.status = "failed";
  info.message = "the <first> step failed";
  writer.write_run_info(info);
  const std::string page = report_html({ResultsReader(scratch / "new.results")});
  EXPECT_NE(page.find("Status: failed, the &lt;first&gt; step failed."), std::string::npos);
  EXPECT_NE(page.find("The ledger has no rows yet."), std::string::npos);
  EXPECT_NE(page.find("The run has no snapshot yet."), std::string::npos);
}

/// The highest points of a column settle by some 7 mm under 30 kPa.
TEST(ReportOfRuns, OfSoilThatMovesHasItsSettlement) {
  const ScratchFolder scratch;
  const ResultsReader run = testing::run_programs(
      scratch, "settles",
      "formulation = \"single-point\"\ngravity = [0.0, -9.81]\n"
      "geometry = { shape = \"column\", width = 0.5, height = 1.0 }\nmesh.size = 0.5\n"
      "liquid = { density = 1000.0, bulk_modulus = inf, viscosity = 1e-3 }\n"
      "initial.water_level = 1.0\ntime.end = 1e6\noutput.every = 5e5\n"
      "[soil.specimen]\nporosity = 0.5\nskeleton_fraction = 0.5\ngrain_density = 2700.0\n"
      "conductivity = 1e-4\nskeleton = { law = \"elastic\", young = 3e6, poisson = 0.3 }\n"
      "[[boundary]]\non = \"top\"\nhead = 1.0\ntraction = [[0, 0, 0], [1, 0, -30e3]]\n"
      "[[boundary]]\non = \"bottom\"\nfix = \"both\"\n"
      "[[boundary]]\non = \"left\"\nfix = \"normal\"\n"
      "[[boundary]]\non = \"right\"\nfix = \"normal\"\n");
  const std::string page = report_html({run});
  const double settlement = run.history().column("settlement_max").back();
  EXPECT_NEAR(settlement, 7e-3, 5e-4);
  char number[32];
  std::snprintf(number, sizeof number, "%.4g", settlement);
  EXPECT_NE(page.find(std::string(" the largest settlement of the soil is ") + number +
                      " m, its largest displacement "),
            std::string::npos);
  EXPECT_EQ(page.find("of fines per metre"), std::string::npos);
  for (const std::string name : {"settlement", "displacement"}) {
    EXPECT_EQ(matches(page, "Largest " + name + " of the soil against time").size(), 1U) << name;
  }
}

TEST(ReportPictures, SnapshotsAreEvenlyInTime) {
  std::vector<double> times;
  for (int k = 0; k <= 100; ++k) times.push_back(k);
  EXPECT_EQ(snapshots_evenly(times, 5), (std::vector<std::size_t>{0, 25, 50, 75, 100}));
  EXPECT_EQ(snapshots_evenly({0.0, 1.0, 100.0}, 12), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(snapshots_evenly({5.0}, 12), (std::vector<std::size_t>{0}));
  EXPECT_TRUE(snapshots_evenly({}, 12).empty());
}

TEST(ReportPictures, TimesHaveAUnitThatFits) {
  EXPECT_EQ(time_text(200.0, fitting_time_unit(200.0)), "200 s");
  EXPECT_EQ(time_text(900.0, fitting_time_unit(1800.0)), "15 min");
  EXPECT_EQ(time_text(432000.0, fitting_time_unit(864000.0)), "5 d");
  EXPECT_EQ(time_text(31557600.0, fitting_time_unit(1e9)), "1 a");
}

TEST(ReportPictures, TimesInWordsTellNeighboursApart) {
  EXPECT_EQ(time_words(20000.0, 22000.0, 2500.0), "5 h 33 min");
  EXPECT_EQ(time_words(20000.0, 22000.0, 10.0), "5 h 33 min 20 s");
  EXPECT_EQ(time_words(20000.1, 22000.0, 0.1), "5 h 33 min 20.1 s");
  EXPECT_EQ(time_words(18000.0, 22000.0, 2500.0), "5 h");
  EXPECT_EQ(time_words(0.0, 22000.0, 2500.0), "0 h");
  EXPECT_EQ(time_words(561600.0, 864000.0, 43200.0), "6 d 12 h");
  EXPECT_EQ(time_words(3599.9, 22000.0, 600.0), "1 h");
  EXPECT_EQ(time_words(120.0, 200.0, 2.0), "120 s");
  EXPECT_EQ(time_words(2e-5, 1e-4, 1e-5), "2e-05 s");
  EXPECT_EQ(time_words(12.5 * 365.25 * 86400.0, 1e9, 1e7), "12.5 a");
  EXPECT_EQ(least_spacing({3.0, 1.0, 1.0, 2.5}), 0.5);
}

TEST(ReportText, IsEscaped) {
  EXPECT_EQ(html::escaped("a<b>\"c\"&'d'"), "a&lt;b&gt;&quot;c&quot;&amp;&#39;d&#39;");
}

TEST(ReportText, AddressesHoldTheBytesOfAFile) {
  const ScratchFolder scratch;
  const std::string path = scratch / "a.png";
  for (const auto& [bytes, text] : std::vector<std::pair<std::string, std::string>>{
           {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"\xff\xfe", "//4="}}) {
    std::ofstream(path, std::ios::binary) << bytes;
    EXPECT_EQ(html::data_address(path), "data:image/png;base64," + text);
  }
}

TEST(ReportText, ArgumentsOfAShellAreQuoted) {
  EXPECT_EQ(shell_argument("a/b-c_1.toml"), "a/b-c_1.toml");
  EXPECT_EQ(shell_argument("boundary[0].head=[1, 2]"), "'boundary[0].head=[1, 2]'");
  EXPECT_EQ(shell_argument("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_argument(""), "''");
}

}  // namespace report_test
}  // namespace suffuse
