#include "figures.hpp"

#include <gtest/gtest.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <cstdlib>
#include <set>

#include "case/errors.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace {

using testing::file_text;
using testing::ScratchFolder;
using testing::write_synthetic_results;

std::vector<ResultsReader> two_runs(const ScratchFolder& scratch) {
  write_synthetic_results(scratch / "slow.results", "slow-run", 1e-3);
  write_synthetic_results(scratch / "fast.results", "fast-run", 5e-3);
  return {ResultsReader(scratch / "slow.results"), ResultsReader(scratch / "fast.results")};
}

/// How many pixels are not white, and how many colours there are.
std::pair<int, std::size_t> ink(const std::string& path) {
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  auto* image = reader->GetOutput();
  const int* size = image->GetDimensions();
  EXPECT_GE(size[0], 1200);
  EXPECT_EQ(size[1], 800);
  int inked = 0;
  std::set<std::array<int, 3>> colors;
  for (int y = 0; y < size[1]; ++y) {
    for (int x = 0; x < size[0]; ++x) {
      std::array<int, 3> color{};
      for (int k = 0; k < 3; ++k) {
        color.at(k) = static_cast<int>(image->GetScalarComponentAsDouble(x, y, 0, k));
      }
      colors.insert(color);
      if (color != std::array<int, 3>{255, 255, 255}) ++inked;
    }
  }
  return {inked, colors.size()};
}

TEST(Figures, PngIsDrawnWithoutADisplay) {
  const ScratchFolder scratch;
  const auto runs = two_runs(scratch);
  unsetenv("DISPLAY");
  for (const std::string name : {"porosity", "masses"}) {
    const std::string path = scratch / (name + ".png");
    ::testing::internal::CaptureStderr();
    draw_charts(make_figure(name, runs), path);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << name;
    const auto [inked, colors] = ink(path);
    EXPECT_GT(inked, 8000) << name;
    EXPECT_LT(inked, 400000) << name;
    EXPECT_GT(colors, 20U) << name;
  }
}

TEST(Figures, PorositySvgHasItsTexts) {
  const ScratchFolder scratch;
  draw_figure("porosity", two_runs(scratch), scratch / "figure.svg");
  const std::string svg = file_text(scratch / "figure.svg");
  EXPECT_NE(svg.find("<svg "), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_EQ(svg.find("<image"), std::string::npos);
  for (const auto* text :
       {"Mean porosity of the soil", "time (s)", "porosity n_L (-)", "slow-run", "fast-run",
        "exact, constant law, 0.001 1/s", "exact, constant law, 0.005 1/s", ">120<", ">0.4<"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

TEST(Figures, MassesSvgHasItsTexts) {
  const ScratchFolder scratch;
  draw_figure("masses", two_runs(scratch), scratch / "figure.svg");
  const std::string svg = file_text(scratch / "figure.svg");
  for (const auto* text : {"mass (kg per metre of thickness)", "slow-run: solid",
                           "slow-run: eroded", "slow-run: liquid", "fast-run: total"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

TEST(Figures, PdfIsAPdf) {
  const ScratchFolder scratch;
  draw_figure("porosity", two_runs(scratch), scratch / "figure.pdf");
  const std::string pdf = file_text(scratch / "figure.pdf");
  EXPECT_TRUE(pdf.starts_with("%PDF-"));
  for (const auto* text : {"(Mean porosity of the soil)", "(slow-run)", "%%EOF"}) {
    EXPECT_NE(pdf.find(text), std::string::npos) << text;
  }
}

// The rows of the synthetic runs follow Eq. 6, so every marker lies on an exact curve.
TEST(Figures, MarkersLieOnTheExactCurves) {
  const ScratchFolder scratch;
  for (const std::string name : {"porosity", "masses", "solid-mass"}) {
    const Chart chart = make_figure(name, two_runs(scratch)).front();
    std::size_t markers = 0;
    for (const auto& points : chart.curves) {
      if (!points.markers) continue;
      ASSERT_GT(points.x.size(), 15U);
      double nearest = 1e300;  // distance to the curve that fits best
      for (const auto& line : chart.curves) {
        if (line.markers) continue;
        double distance = 0.0;
        for (std::size_t i = 0; i < points.x.size(); ++i) {
          const auto at = std::lower_bound(line.x.begin(), line.x.end(), points.x[i] - 1e-9);
          ASSERT_NE(at, line.x.end());
          distance = std::max(distance, std::abs(line.y[at - line.x.begin()] - points.y[i]) /
                                            std::max(1.0, points.y[i]));
        }
        nearest = std::min(nearest, distance);
      }
      EXPECT_LT(nearest, 1e-12) << name << ": " << points.label;
      ++markers;
    }
    EXPECT_EQ(markers, name == "masses" ? 8U : 2U);
  }
}

TEST(Figures, RunsOfOneNameAreToldApartByFolder) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "coarse.results");
  write_synthetic_results(scratch / "fine.results");
  const Chart chart = make_figure("porosity", {ResultsReader(scratch / "coarse.results"),
                                               ResultsReader(scratch / "fine.results")})
                          .front();
  ASSERT_EQ(chart.curves.size(), 3U);  // one exact curve for both
  EXPECT_EQ(chart.curves[1].label, "coarse");
  EXPECT_EQ(chart.curves[2].label, "fine");
  EXPECT_NE(chart.curves[1].marker, chart.curves[2].marker);
}

TEST(Figures, TitlesSayWhenSoilIsLeftOut) {
  const ScratchFolder scratch;
  Case<2> c = testing::unit_square_case();
  c.document =
      parse_scene(c.document.text + "[soil.base]\nlike = \"specimen\"\nerosion.law = \"none\"\n",
                  "layers.toml");
  c.mesh.region_names.emplace_back("base");
  c.mesh.element_region.back() = 1;
  {
    ResultsWriter<2> writer(scratch / "layers.results", c);
    testing::write_rows(writer, 2.0, [](double) { return 0.3; });
    writer.write_run_info({});
  }
  const std::vector<ResultsReader> layers{ResultsReader(scratch / "layers.results")};
  EXPECT_EQ(make_figure("porosity", layers).front().title, "Mean porosity of the soil that erodes");
  EXPECT_EQ(make_figure("masses", layers).front().title,
            "Mass balance in closed accounting (in the soil that erodes + left - entered)");
  EXPECT_EQ(make_figure("porosity", two_runs(scratch)).front().title, "Mean porosity of the soil");
}

TEST(Figures, TicksAreRoundAndEnclose) {
  const auto ticks = round_ticks(0.3, 0.3987);
  EXPECT_NEAR(ticks.front(), 0.3, 1e-15);
  EXPECT_NEAR(ticks.back(), 0.4, 1e-15);
  EXPECT_NEAR(ticks[1] - ticks[0], 0.02, 1e-15);
  const auto flat = round_ticks(0.3, 0.3);
  EXPECT_LT(flat.front(), 0.3);
  EXPECT_GT(flat.back(), 0.3);
}

}  // namespace
}  // namespace suffuse
