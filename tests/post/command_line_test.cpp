#include <gtest/gtest.h>
#include <sys/wait.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cstdlib>
#include <regex>

#include "post/synthetic_results.hpp"
#include "results/reader.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace command_line_test {

namespace fs = std::filesystem;
using testing::file_text;
using testing::ScratchFolder;
using testing::unit_square_case;
using testing::write_synthetic_results;

struct Outcome {
  int code;
  std::string out;
  std::string error;
};

Outcome post(const ScratchFolder& scratch, const std::string& arguments) {
  const std::string out = scratch / "stdout.txt";
  const std::string error = scratch / "stderr.txt";
  const std::string command = std::string("env -u DISPLAY ") + test::program_folder() +
                              "/suffuse-post " + arguments + " > " + out + " 2> " + error;
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(out), file_text(error)};
}

/// A folder with a good run in `run`.
class PostCommand : public ::testing::Test {
 protected:
  PostCommand() { write_synthetic_results(run); }
  [[nodiscard]] Outcome post(const std::string& arguments) const {
    return command_line_test::post(scratch, arguments);
  }
  void expect_refusal(const std::string& arguments, int code, const std::string& message) const {
    const Outcome outcome = post(arguments);
    EXPECT_EQ(outcome.code, code) << arguments;
    EXPECT_EQ(outcome.error, message + "\n") << arguments;
  }

  const ScratchFolder scratch;
  const std::string run = scratch / "run.results";
  const std::string sample_start = "sample " + run + " --csv " + scratch / "s.csv" + " ";
};

TEST_F(PostCommand, AnEmptyArgumentIsNotTakenForNone) {
  const std::vector<std::string> commands{"ledger " + run + " --csv ''",
                                          "render " + run + " --field porosity -o ''", "history ''",
                                          "figure porosity " + run + " -o ''"};
  for (const std::string& command : commands) {
    const Outcome outcome = post(command);
    EXPECT_EQ(outcome.code, 2) << command;
    EXPECT_NE(outcome.error.find("expected a value"), std::string::npos) << outcome.error;
  }
}

void expect_equal(const Table& a, const Table& b) {
  EXPECT_EQ(a.names, b.names);
  EXPECT_EQ(a.columns, b.columns);
}

TEST_F(PostCommand, LedgerPrintsTheBalance) {
  const Outcome outcome = post("ledger " + run + " --csv " + scratch / "ledger.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_EQ(outcome.error, "");
  EXPECT_NE(outcome.out.find("worst residual"), std::string::npos);
  EXPECT_NE(outcome.out.find("grains"), std::string::npos);
  expect_equal(read_table(scratch / "ledger.csv"), read_table(run + "/ledger.csv"));
  EXPECT_EQ(file_text(scratch / "ledger.csv").find("t [s],solid [kg/m],"), 0U);
}

TEST_F(PostCommand, NothingIsWrittenIntoTheResults) {
  const std::string table = file_text(run + "/ledger.csv");
  const std::string linked = scratch / "link";
  fs::create_directory_symlink(run, linked);
  const auto refusal = [this](const std::string& option, const std::string& path) {
    return "suffuse-post: " + option + ": got \"" + path + "\"; expected a place outside " + run +
           ", which belongs to suffuse-solver";
  };
  for (const std::string& inside :
       {run + "/ledger.csv", run + "/../run.results/a.csv", linked + "/a.csv"}) {
    expect_refusal("ledger " + run + " --csv " + inside, 2, refusal("--csv", inside));
    expect_refusal("history " + run + " --csv " + inside, 2, refusal("--csv", inside));
  }
  for (const std::string& inside : {run, run + "/", run + "/snapshots", linked + "/new/folder"}) {
    expect_refusal("export " + run + " -o " + inside, 2, refusal("-o", inside));
  }
  expect_refusal("figure porosity " + run + " -o " + run + "/a.png", 2,
                 refusal("-o", run + "/a.png"));
  EXPECT_EQ(file_text(run + "/ledger.csv"), table);
  EXPECT_EQ(post("ledger " + run + " --csv " + run + ".csv").code, 0);  // next to the folder
  EXPECT_EQ(post("ledger " + run + " --csv " + scratch / "a.csv").code, 0);
}

TEST_F(PostCommand, AMisspeltCommandIsNamed) {
  expect_refusal("ledgr " + run, 2,
                 "suffuse-post: error: got \"ledgr\"; expected \"ledger\", \"history\", "
                 "\"boundaries\", \"check\", \"sample\", "
                 "\"error\", \"render\", \"animate\", \"figure\", \"sweep\", "
                 "\"table\", \"export\" or \"report\"; did you mean ledger?");
}

TEST_F(PostCommand, LedgerRefusesAResidual) {
  const Case<2> c = unit_square_case();
  ResultsWriter<2> writer(scratch / "leak.results", c);
  LedgerRow row;
  row.solid = 1890.0;
  row.water = 300.0;
  writer.append_ledger(row);
  row.t = 5.0;
  row.residual_grains = -3e-9;
  writer.append_ledger(row);
  const std::string leak = scratch / "leak.results";
  expect_refusal("ledger " + leak, 3,
                 "suffuse-post: error: model: grains: residual 3e-09 at t = 5 s is larger "
                 "than the tolerance 1e-12");
  EXPECT_EQ(post("ledger " + leak + " --tolerance 1e-8").code, 0);
}

/// Free water has no grains until soil slides into it: the residual is a share of that soil.
TEST_F(PostCommand, LedgerTakesSoilThatSlidInAsMassOfTheRegion) {
  const std::string slide = scratch / "slide.results";
  const Case<2> c = testing::open_above_case(1.0);
  ResultsWriter<2> writer(slide, c);
  LedgerRow soil;
  LedgerRow water;
  soil.solid = 2000.0;
  soil.water = water.water = 300.0;
  const auto append = [&] {
    LedgerRow model;
    model.t = soil.t;
    model.solid = 2000.0;
    model.water = 600.0;
    writer.append_ledger(model);
    writer.append_regions(std::array<RegionRow, 2>{{{0, 0.3, soil}, {1, 1.0, water}}});
  };
  append();
  soil.t = water.t = 5.0;
  soil.solid = 1500.0;
  soil.carried = -500.0;
  water.carried = 500.0;
  water.solid = 500.0 + 3e-10;
  append();
  EXPECT_EQ(post("ledger " + slide).code, 0);
  water.t = soil.t = 7.0;
  water.solid = 500.0 + 5e-9;
  append();
  const std::string message = post("ledger " + slide).error;
  EXPECT_NE(message.find("free_above: grains: residual 1e-11 at t = 7 s"), std::string::npos)
      << message;
}

TEST_F(PostCommand, LedgerFindsALossThatTheRunDidNotReport) {
  const Case<2> c = unit_square_case();
  ResultsWriter<2> writer(scratch / "leak.results", c);
  LedgerRow row;
  row.solid = 1890.0;
  row.water = 300.0;
  writer.append_ledger(row);
  row.t = 7.0;
  row.water = 299.7;
  writer.append_ledger(row);
  expect_refusal("ledger " + scratch / "leak.results", 3,
                 "suffuse-post: error: model: water: residual 0.001 at t = 7 s is larger "
                 "than the tolerance 1e-12");
}

TEST_F(PostCommand, ErrorAgainstATable) {
  const std::string known = scratch / "known.csv";
  std::ofstream(known) << "t,porosity_mean\n10,0.616\n";
  const Outcome outcome =
      post("error " + run + " --reference " + known + " --csv " + scratch / "errors.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_EQ(outcome.out, "porosity_mean: L1 0.5, L2 0.5, largest 0.5 of 1 values\n");
  EXPECT_TRUE(file_text(scratch / "errors.csv").starts_with("quantity,values,l1,l2,max\n"));
  expect_refusal("error " + run + " --reference " + known + " --csv " + run + "/errors.csv", 2,
                 "suffuse-post: --csv: got \"" + run + "/errors.csv\"; expected a place outside " +
                     run + ", which belongs to suffuse-solver");
  std::ofstream(known) << "t,porosity_mean\n130,0.616\n";
  expect_refusal("error " + run + " --reference " + known, 2,
                 "suffuse-post error: " + known +
                     ": t: got 130; expected a time from 0 to 120 s, which the run has");
  EXPECT_EQ(post("error " + run + " --reference " + scratch / "none.csv").code, 4);
}

TEST_F(PostCommand, LedgerRefusesNaN) {
  const Case<2> c = unit_square_case();
  ResultsWriter<2> writer(scratch / "nan.results", c);
  LedgerRow row;
  row.solid = 1890.0;
  row.water = 300.0;
  row.residual_water = std::nan("");
  writer.append_ledger(row);
  EXPECT_EQ(post("ledger " + scratch / "nan.results").code, 3);
}

TEST_F(PostCommand, HistoryPrintsAndCopies) {
  const Outcome outcome = post("history " + run + " --csv " + scratch / "h.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_NE(outcome.out.find("porosity_mean"), std::string::npos);
  expect_equal(read_table(scratch / "h.csv"), read_table(run + "/history.csv"));
  // Only the table is written to standard output.
  for (const std::string command : {"ledger", "history", "boundaries"}) {
    expect_refusal(command + " " + run + " --time-unit fortnight", 2,
                   "suffuse-post " + command +
                       ": --time-unit: got \"fortnight\"; expected \"s\", \"min\", \"h\", \"d\" "
                       "or \"a\"");
  }
  const Outcome shown = post("history " + run + " --csv - --time-unit min");
  EXPECT_EQ(shown.out.find("t [min],dt [s],porosity_mean [-],"), 0U) << shown.out;
  const Outcome ranges = post("history " + run + " --time-unit min");
  EXPECT_TRUE(std::regex_search(ranges.out, std::regex("\nt \\[min\\] +0 +2 +0 +2\n")))
      << ranges.out;
}

TEST_F(PostCommand, BoundariesAreSummedUpAndWritten) {
  const Outcome outcome = post("boundaries " + run + " --csv " + scratch / "b.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_EQ(outcome.out, run +
                             ": done, since the start until t = 120 s, per metre of thickness\n"
                             "            water in     water out      fines in     fines out     "
                             "liquid in    liquid out     discharge\n"
                             "                  kg            kg            kg            kg       "
                             "     m3            m3          m3/s\n"
                             "top              480             0             0             0       "
                             "   0.48             0        -0.004\n"
                             "bottom             0           480             0           270       "
                             "      0          0.58         0.005\n"
                             "all              480           480             0           270       "
                             "   0.48          0.58         0.001\n");
  const auto written = read_tables(scratch / "b.csv", "boundary");
  ASSERT_EQ(written.size(), 2U);
  expect_equal(written[1].table, read_tables(run + "/boundaries.csv", "boundary")[1].table);
  const std::string inside = run + "/b.csv";
  EXPECT_EQ(post("boundaries " + run + " --csv " + inside).code, 2);
}

TEST_F(PostCommand, SampleWritesATable) {
  const Outcome outcome =
      post(sample_start + "--time 10 --line 0.5,0:0.5,1 --count 3 --fields porosity,darcy_flux");
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  const Table table = read_table(scratch / "s.csv");
  EXPECT_EQ(table.names,
            (std::vector<std::string>{"t", "x", "y", "porosity", "darcy_flux_x", "darcy_flux_y"}));
  EXPECT_EQ(table.rows(), 3U);
}

TEST_F(PostCommand, FigureWritesEveryFormat) {
  for (const std::string suffix : {"png", "svg", "pdf"}) {
    const std::string path = scratch / ("figure." + suffix);
    const Outcome outcome = post("figure masses " + run + " -o " + path);
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_EQ(outcome.error, "");
    EXPECT_GT(fs::file_size(path), 5000U);
  }
}

TEST_F(PostCommand, ExportWritesVtu) {
  const Outcome outcome = post("export " + run + " -o " + scratch / "vtu");
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const std::string collection = file_text(scratch / "vtu/solid.pvd");
  EXPECT_NE(collection.find("timestep=\"40\" part=\"0\" file=\"solid_000002.vtu\""),
            std::string::npos);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  const std::string path = scratch / "vtu/solid_000002.vtu";
  reader->SetFileName(path.c_str());
  reader->Update();
  auto* porosity = reader->GetOutput()->GetPointData()->GetArray("porosity");
  ASSERT_NE(porosity, nullptr);
  EXPECT_DOUBLE_EQ(porosity->GetComponent(3, 0), 40.3);
}

TEST_F(PostCommand, DoublePointLedgerCountsPendingGrains) {
  testing::double_point::write_results(scratch / "dp.results");
  const Outcome outcome = post("ledger " + scratch / "dp.results");
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_NE(outcome.out.find("pending grains: 2.646 kg, at most 2.646 kg at t = 100 s\n"
                             "liquid points: 72; entered 300, left 300\n"),
            std::string::npos)
      << outcome.out;
  EXPECT_EQ(post("ledger " + run).out.find("pending"), std::string::npos);
}

TEST_F(PostCommand, DoublePointExportHasTheLiquidPoints) {
  testing::double_point::write_results(scratch / "dp.results");
  const Outcome outcome = post("export " + scratch / "dp.results" + " -o " + scratch / "vtu");
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_NE(file_text(scratch / "vtu/liquid.pvd")
                .find("timestep=\"10\" part=\"0\" "
                      "file=\"liquid_000001.vtu\""),
            std::string::npos);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  const std::string path = scratch / "vtu/liquid_000001.vtu";
  reader->SetFileName(path.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 66);
  auto* pressure = reader->GetOutput()->GetPointData()->GetArray("pressure");
  ASSERT_NE(pressure, nullptr);
  EXPECT_EQ(pressure->GetComponent(24, 0), 27.0);  // element 8 lacks its three points
}

TEST_F(PostCommand, RenderNamesItsPictures) {
  const std::string picture = scratch / "p.png";
  Outcome outcome = post("render " + run + " --field porosity --time 12 -o " + picture);
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_EQ(outcome.out, picture + "\n");
  EXPECT_GT(fs::file_size(picture), 5000U);
  outcome = post("render " + run + " --field porosity --all --range 0.3,0.4 -o " + picture);
  EXPECT_EQ(outcome.out, scratch / "p_0000.png" + "\n" + scratch / "p_0001.png" + "\n" +
                             scratch / "p_0002.png" + "\n");
  EXPECT_EQ(post("render " + run + " --field porosity --all --time 1 -o " + picture).code, 2);
  expect_refusal("render " + run + " --field porosity --range 2,1 -o " + picture, 2,
                 "suffuse-post render: --range: got \"2,1\"; expected LO:HI with LO below HI by "
                 "more than round-off");
  expect_refusal("render " + run + " --field porosity -o " + run + "/a.png", 2,
                 "suffuse-post: -o: got \"" + run + "/a.png\"; expected a place outside " + run +
                     ", which belongs to suffuse-solver");
}

TEST_F(PostCommand, TableHasARowPerRun) {
  testing::double_point::write_results(scratch / "dp.results");
  const Outcome outcome =
      post("table " + run + " " + scratch / "dp.results" + " --csv " + scratch / "t.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  const std::string text = file_text(scratch / "t.csv");
  EXPECT_EQ(text.find("run,status,formulation,law,rate,"), 0U);
  EXPECT_NE(text.find("\nrun,done,single-point,constant,0.001,"), std::string::npos);
  EXPECT_NE(text.find("\ndp,done,double-point,constant,0.001,0.02,"), std::string::npos);
}

TEST_F(PostCommand, UnknownField) {
  expect_refusal(
      sample_start + "--time 10 --line 0.5,0:0.5,1 --count 3 --fields porosty", 2,
      "suffuse-post sample: --fields: got \"porosty\"; expected \"conductivity\", \"darcy_flux\", "
      "\"fines_fraction\", \"head\", \"liquid_velocity\", \"porosity\", "
      "\"pressure\", \"region\", \"saturation\" or \"water_fraction\"; did you "
      "mean porosity?");
  EXPECT_FALSE(fs::exists(scratch / "s.csv"));
}

TEST_F(PostCommand, AFieldThatTheSceneLacksIsNamedWithItsKey) {
  expect_refusal(
      "render " + run + " --field displacement", 2,
      "suffuse-post render: --field: got \"displacement\" of soil that does not move; "
      "expected soil.NAME.skeleton in the scene, such as skeleton = { law = \"elastic\", "
      "young = 2e7, poisson = 0.3 }");
  expect_refusal("figure gradation " + run + " -o " + scratch / "f.png", 4,
                 "suffuse-post: error: " + run +
                     ": no soil of its scene has a gradation; expected soil.NAME.gradation in the "
                     "scene, such as gradation = [[0.1, 0], [1.0, 60], [4.0, 100]]");
}

TEST_F(PostCommand, TimeOutside) {
  for (const std::string time : {"40.1", "-1", "nan"}) {
    expect_refusal(
        sample_start + "--time " + time + " --line 0.5,0:0.5,1 --count 3 " + "--fields porosity", 2,
        "suffuse-post sample: --time: got " + time +
            "; expected a time from 0 to 40 s, the first and last snapshot");
  }
}

TEST_F(PostCommand, ReportPrintsItsProgressUnlessQuiet) {
  const std::string page = scratch / "a.html";
  const Outcome outcome = post("report " + run + " -o " + page);
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.error.find("suffuse-post report: pictures of head, 3 times\n"),
            std::string::npos)
      << outcome.error;
  EXPECT_EQ(post("report --quiet " + run + " -o " + page).error, "");
}

TEST_F(PostCommand, TimesMayHaveAUnit) {
  const std::string place = " --at 0.5,0.5 --fields porosity";
  for (const std::string time :
       {"--time 30s", "--time 0.5min", "--time '0.5 min'", "--times 30s", "--times 0.5min"}) {
    EXPECT_EQ(post(sample_start + time + place).code, 0) << time;
    EXPECT_EQ(read_table(scratch / "s.csv").column("t"), std::vector{30.0}) << time;
  }
  const std::string picture = scratch / "p.svg";
  EXPECT_EQ(post("render " + run + " --field porosity --time 0.5min -o " + picture).code, 0);
  EXPECT_NE(file_text(picture).find("snapshot nearest to 30 s"), std::string::npos);
  const std::string expected =
      "in s, or with a unit behind the number, \"s\", \"min\", \"h\", \"d\" or \"a\", as 2.5d";
  for (const std::string time : {"5hours", "d", "1d2h", "0.5 weeks"}) {
    const std::string found = ": got \"" + time + "\"; expected ";
    const std::string option = "--time '" + time + "'";
    expect_refusal(sample_start + option + place, 2,
                   "suffuse-post sample: --time" + found + "a time " + expected);
    expect_refusal("render " + run + " --field porosity " + option + " -o " + picture, 2,
                   "suffuse-post render: --time" + found + "a time " + expected);
    expect_refusal("figure head " + run + " " + option + " -o " + picture, 2,
                   "suffuse-post figure: --time" + found + "a time " + expected);
  }
  expect_refusal(sample_start + "--times 1,5hours" + place, 2,
                 "suffuse-post sample: --times: got \"1,5hours\"; expected all, or times with "
                 "commas between, each " +
                     expected);
}

TEST_F(PostCommand, PointOutside) {
  expect_refusal(sample_start + "--time 1 --line 0.5,0:0.5,2 --count 3 --fields porosity", 2,
                 "suffuse-post sample: --line: got the point (0.5, 2); expected points inside the "
                 "model");
}

TEST_F(PostCommand, BadLine) {
  for (const std::string line : {"0.5,0", "0.5,0:1", "0.5,0:1,x", "0,0:1,1:2,2", "1,2,3:4", ":"}) {
    expect_refusal(sample_start + "--time 1 --line " + line + " --count 3 --fields porosity", 2,
                   "suffuse-post sample: --line: got \"" + line +
                       "\"; expected x0,y0:x1,y1 or "
                       "x0,y0,z0:x1,y1,z1 in metres");
  }
}

TEST_F(PostCommand, ExportNamesADamagedSnapshotAndWritesNothing) {
  const std::string damaged = ResultsReader(run).snapshot_path("solid", 1);
  fs::resize_file(damaged, fs::file_size(damaged) / 2);
  const Outcome outcome = post("export " + run + " -o " + scratch / "vtk");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_EQ(outcome.error.find("suffuse-post: error: " + damaged + ": cannot be opened"), 0U)
      << outcome.error;
  EXPECT_FALSE(fs::exists(scratch / "vtk"));
}

TEST_F(PostCommand, BadCount) {
  expect_refusal(sample_start + "--time 1 --line 0,0:0,0 --count 3 --fields porosity", 2,
                 "suffuse-post sample: --line: got \"0,0:0,0\"; expected two ends that differ");
  expect_refusal(sample_start + "--time 1 --line 0,0:1,1 --count 1 --fields porosity", 2,
                 "suffuse-post sample: --count: got 1; expected at least 2, the ends of the line");
  expect_refusal(sample_start + "--time 1 --line 0,0:1,1 --count 2000000000 --fields porosity", 2,
                 "suffuse-post sample: --count: got 2000000000; expected at most 1000000");
}

TEST_F(PostCommand, EmptyFieldName) {
  expect_refusal(sample_start + "--time 1 --line 0,0:1,1 --count 2 --fields porosity,", 2,
                 "suffuse-post sample: --fields: got \"porosity,\"; expected names of fields with "
                 "commas between");
}

TEST_F(PostCommand, UnknownFigure) {
  expect_refusal(
      "figure porosty " + run + " -o " + scratch / "f.png", 2,
      "suffuse-post figure: NAME: got \"porosty\"; expected \"boundaries\", "
      "\"comparison\", \"curves\", \"empty-elements\", \"fines-lost\", \"flownet\", \"flux\", "
      "\"gradation\", \"head\", "
      "\"masses\", "
      "\"model\", \"outflow\", \"porosity\", \"profile\", \"saturation\", \"slip\" or "
      "\"solid-mass\"; did you mean "
      "porosity?");
  EXPECT_FALSE(fs::exists(scratch / "f.png"));
}

TEST_F(PostCommand, UnknownPictureFormat) {
  expect_refusal("figure porosity " + run + " -o f.bmp", 2,
                 "suffuse-post figure: -o: got \"f.bmp\"; expected a name that ends in .png, .svg "
                 "or .pdf");
}

TEST_F(PostCommand, PictureInNoFolder) {
  const std::string folder = scratch / "nowhere";
  expect_refusal(
      "figure porosity " + run + " -o " + folder + "/f.png", 4,
      "suffuse-post: error: " + folder + "/f.png: cannot be created: there is no folder " + folder);
}

TEST_F(PostCommand, NotAResultsFolder) {
  const std::string nothing = scratch / "nothing";
  expect_refusal("ledger " + nothing, 4,
                 "suffuse-post: error: " + nothing + ": no such results folder");
  fs::create_directories(nothing);
  expect_refusal(
      "ledger " + nothing, 4,
      "suffuse-post: error: " + nothing + ": is not a results folder: it has no run.json");
  std::ofstream(nothing + "/run.json") << "{\"format\": \"other\"}";
  expect_refusal(
      "history " + nothing, 4,
      "suffuse-post: error: " + nothing + "/run.json: was not written by suffuse-solver");
}

TEST_F(PostCommand, MisspeltCommandsAndOptions) {
  expect_refusal("", 2, "suffuse-post: error: A subcommand is required (see --help)");
  EXPECT_EQ(post("legder " + run).code, 2);
  EXPECT_EQ(post("ledger " + run + " --tolerence 1").code, 2);
  for (const std::string value : {"-1", "nan"}) {
    expect_refusal("ledger " + run + " --tolerance " + value, 2,
                   "suffuse-post ledger: --tolerance: got " + value +
                       "; expected a number that is not negative");
  }
  EXPECT_EQ(post("ledger").code, 2);
  EXPECT_EQ(post("--help").code, 0);
}

TEST_F(PostCommand, TablesOfRunsAndErrorsGoToStandardOutput) {
  std::ofstream(scratch / "known.csv") << "t,x,y,porosity\n10,0.5,0.5,0.4\n";
  fs::remove("-");
  const Outcome table = post("table " + run + " --csv -");
  EXPECT_EQ(table.out.find("run,status,"), 0U) << table.out << table.error;
  const Outcome error = post("error " + run + " --reference " + scratch / "known.csv" + " --csv -");
  EXPECT_EQ(error.out.find("quantity,values,l1,l2,max\nporosity,1,"), 0U)
      << error.out << error.error;
  EXPECT_FALSE(fs::exists("-"));
}

TEST_F(PostCommand, NoNumberIsNoLimit) {
  expect_refusal("check " + run + " --least nan", 2,
                 "suffuse-post: error: --least: Value nan is not a number (see --help)");
  EXPECT_NE(post("check " + run + " --least -1").error.find("Value -1 not in range"),
            std::string::npos);
}

}  // namespace command_line_test
}  // namespace suffuse
