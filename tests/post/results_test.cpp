#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkHDFReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "common/errors.hpp"
#include "common/hdf5_io.hpp"
#include "post/synthetic_results.hpp"
#include "results/reader.hpp"
#include "tables/discharge_text.hpp"

namespace suffuse {
namespace results_test {

namespace fs = std::filesystem;
using testing::file_text;
using testing::linear_snapshot;
using testing::ScratchFolder;
using testing::unit_square_case;
using testing::write_synthetic_results;

void expect_field(const Field& got, const Field& wanted) {
  EXPECT_EQ(got.name, wanted.name);
  EXPECT_EQ(got.unit, wanted.unit);
  EXPECT_EQ(got.components, wanted.components);
  EXPECT_EQ(got.values, wanted.values);
}

TEST(Results, SnapshotsReadBackExactly) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "run.results");
  const ResultsReader reader(scratch / "run.results");
  const Case<2> c = unit_square_case();
  ASSERT_EQ(reader.times(), (std::vector<double>{0.0, 10.0, 40.0}));
  const Snapshot wanted = linear_snapshot(c, 40.0, 2);
  for (const auto& field : wanted.cell) expect_field(reader.field(2, "cell", field.name), field);
  for (const auto& field : wanted.node) expect_field(reader.field(2, "node", field.name), field);
  for (const auto& field : wanted.solid) expect_field(reader.field(2, "solid", field.name), field);
  for (const auto& field : wanted.element_vertex) {
    expect_field(reader.field(2, "element_vertex", field.name), field);
  }
  auto names = reader.field_names(2, "cell");
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"darcy_flux", "porosity", "pressure", "region"}));
}

TEST(Results, MeshAndSceneReadBack) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "run.results");
  const ResultsReader reader(scratch / "run.results");
  const Case<2> c = unit_square_case();
  EXPECT_EQ(reader.mesh().elements, c.mesh.elements);
  EXPECT_EQ(reader.mesh().nodes, c.mesh.nodes);
  EXPECT_EQ(reader.mesh().boundaries.at(1).name, "top");
  EXPECT_EQ(reader.scene().text, c.document.text);
  EXPECT_EQ(reader.scene().scene.name, "synthetic");
  EXPECT_EQ(reader.regions(), std::vector<std::string>{"specimen"});
  EXPECT_EQ(reader.status(), "done");
  EXPECT_EQ(reader.dimension(), 2);
}

TEST(Results, TablesReadBackExactly) {
  const ScratchFolder scratch;
  const Case<2> c = unit_square_case();
  ResultsWriter<2> writer(scratch / "run.results", c);
  HistoryRow history;
  history.t = 0.1;
  history.dt = 1.0 / 3.0;
  history.porosity_mean = std::nextafter(0.3, 1.0);
  history.speed_max = 5e-324;
  history.pressure_max = -1.7976931348623157e308;
  writer.append_history(history);
  LedgerRow ledger;
  ledger.t = 0.1;
  ledger.residual_grains = 1e-17;
  writer.append_ledger(ledger);
  const RegionRow region{3, 2.0 / 3.0, ledger};
  writer.append_regions(std::span(&region, 1));

  // Appended rows are on the disk although nothing was closed or destroyed.
  const ResultsReader reader(scratch / "run.results");
  const Table read = reader.history();
  ASSERT_EQ(read.rows(), 1U);
  for (const auto& [name, member, unit] : history_columns) {
    EXPECT_EQ(read.column(std::string(name)).front(), history.*member) << name;
  }
  EXPECT_EQ(reader.ledger().column("residual_grains").front(), 1e-17);
  const Table regions = reader.region_ledgers();
  EXPECT_EQ(regions.names[0] + "," + regions.names[1] + "," + regions.names[2],
            "t,region,porosity_mean");
  EXPECT_EQ(regions.column("region").front(), 3.0);
  EXPECT_EQ(regions.column("porosity_mean").front(), 2.0 / 3.0);
  EXPECT_EQ(regions.column("residual_grains").front(), 1e-17);
}

TEST(Results, SayHowFarTheDischargeCanBeOff) {
  const ScratchFolder scratch;
  ResultsWriter<2> writer(scratch / "run.results", unit_square_case());
  const auto text = [&] { return discharge_text(ResultsReader(scratch / "run.results")); };
  HistoryRow row;
  row.flux_out = 1.408e-4;
  writer.append_history(row);
  EXPECT_EQ(text(), "");
  row.t = 10.0;
  row.flux_out_low = 1.407e-4;
  row.flux_out_high = 1.41e-4;
  writer.append_history(row);
  const std::string bounds = "Q = 0.0001408 m3/s per m at t = 10 s, between 0.0001407 and 0.000141";
  EXPECT_EQ(text(), bounds);
  HistoryRow unknown;
  unknown.t = 15.0;
  writer.append_history(unknown);
  EXPECT_EQ(text(), bounds) << "the last time that has an interval";
  unknown.t = 20.0;
  unknown.flux_out = 2e-4;
  unknown.flux_out_estimate = 1e-6;
  writer.append_history(unknown);
  EXPECT_EQ(text(),
            "Q = 0.0002 m3/s per m at t = 20 s, by an estimate of the mesh's error to +- 1e-06");
}

TEST(Results, BoundariesReadBackByNameWhateverTheName) {
  const ScratchFolder scratch;
  Case<2> c = unit_square_case();
  c.document.scene.boundaries[1].on = "toe, \"left\"";
  ResultsWriter<2> writer(scratch / "run.results", c);
  const std::vector<BoundaryRow> rows{
      {0.1, "top", 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 0.5},
      {0.1, "toe, \"left\"", 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, std::nextafter(0.3, 1.0), 0.0}};
  writer.append_boundaries(rows);
  writer.append_boundaries(rows);
  EXPECT_TRUE(file_text(scratch / "run.results/boundaries.csv")
                  .starts_with("t,boundary,water_in,water_out,fines_in,fines_out,liquid_in,"
                               "liquid_out,discharge,level,discharge_low,discharge_high,discharge_"
                               "estimate,discharge_time_estimate,discharge_transport_estimate\n"
                               "0.1,top,1,2,3,4,5,6,7,0.5,0,0,0,0,0\n"
                               "0.1,\"toe, \"\"left\"\"\",8,9,"));
  const auto read = ResultsReader(scratch / "run.results").boundaries();
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_EQ(read[b].name, rows[b].boundary);
    EXPECT_EQ(read[b].table.rows(), 2U);
    for (const auto& [name, member, unit] : boundary_columns) {
      EXPECT_EQ(read[b].table.column(std::string(name)).back(), rows[b].*member) << name;
    }
  }
  EXPECT_THROW(read_tables(scratch / "run.results/ledger.csv", "boundary"), FileError);
}

TEST(Results, ProbesAndSectionsAreThereWhereTheSceneHasThem) {
  const ScratchFolder scratch;
  Case<2> c = unit_square_case();
  { const ResultsWriter<2> none(scratch / "none.results", c); }
  EXPECT_FALSE(fs::exists(scratch / "none.results/probes.csv"));
  EXPECT_FALSE(fs::exists(scratch / "none.results/sections.csv"));
  c.document.scene.output.probes.resize(2);
  c.document.scene.output.sections.resize(1);
  ResultsWriter<2> writer(scratch / "run.results", c);
  const ProbeRow probe{0.1, 1.0, 0.25, 0.5, -9.5, 1.5, 0.75, 0.3, 0.01, 1e-6, -1.0 / 3.0};
  writer.append_probes(std::span(&probe, 1));
  const SectionRow section{0.1, 0.0, 1.0 / 7.0, -2.5};
  writer.append_sections(std::span(&section, 1));
  const ResultsReader reader(scratch / "run.results");
  EXPECT_EQ(reader.probes().names.size(), probe_columns.size());
  for (const auto& [name, member, unit] : probe_columns) {
    EXPECT_EQ(reader.probes().column(std::string(name)).front(), probe.*member) << name;
  }
  for (const auto& [name, member, unit] : section_columns) {
    EXPECT_EQ(reader.sections().column(std::string(name)).front(), section.*member) << name;
  }
}

TEST(Results, HistoryBeginsWithTheDocumentedColumns) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "run.results");
  EXPECT_TRUE(file_text(scratch / "run.results/history.csv")
                  .starts_with("t,dt,porosity_mean,flux_in,flux_out,liquid_points,empty_elements,"
                               "empty_elements_total"));
  EXPECT_TRUE(file_text(scratch / "run.results/ledger.csv")
                  .starts_with("t,solid,erodible,water,fines,eroded,water_in,fines_in,water_out,"
                               "fines_out,residual_water,residual_grains,pending,points,"
                               "points_in,points_out,deposited,carried\n"));
}

TEST(Results, RunInfoHasItsKeys) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "run.results");
  const auto json = nlohmann::json::parse(file_text(scratch / "run.results/run.json"));
  for (const auto* key : {"status", "steps", "solid_points", "liquid_points", "elements", "threads",
                          "wall_seconds", "passes", "plan", "warnings", "regions", "dimension"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["status"], "done");
  EXPECT_EQ(json["passes"][0]["name"], "flow");
  EXPECT_EQ(json["passes"][0]["calls"], 3);
  EXPECT_EQ(json["passes"][0]["seconds"], 0.25);
  EXPECT_EQ(json["scene"]["path"], "synthetic.toml");
  for (const auto* key : {"suffuse", "git", "hdf5", "eigen", "compiler"}) {
    EXPECT_FALSE(json["versions"][key].get<std::string>().empty()) << key;
  }
}

TEST(Results, SeriesNamesTheSnapshotsWithTheirTimes) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "run.results");
  for (const std::string kind : {"mesh", "solid"}) {
    const auto json =
        nlohmann::json::parse(file_text(scratch / ("run.results/" + kind + ".hdf.series")));
    EXPECT_EQ(json["file-series-version"], "1.0");
    ASSERT_EQ(json["files"].size(), 3U);
    EXPECT_EQ(json["files"][1]["name"], "snapshots/" + kind + "_000001.hdf");
    EXPECT_EQ(json["files"][1]["time"], 10.0);
  }
}

vtkUnstructuredGrid* read_vtk(vtkHDFReader& reader, const std::string& path) {
  EXPECT_EQ(reader.CanReadFile(path.c_str()), 1) << path;
  reader.SetFileName(path.c_str());
  reader.Update();
  return vtkUnstructuredGrid::SafeDownCast(reader.GetOutputDataObject(0));
}

void expect_array(vtkDataArray* array, const Field& field) {
  ASSERT_NE(array, nullptr) << field.name;
  const int width = field.components == 2 ? 3 : field.components;
  ASSERT_EQ(array->GetNumberOfComponents(), width) << field.name;
  const auto entities = static_cast<vtkIdType>(field.values.size()) / field.components;
  ASSERT_EQ(array->GetNumberOfTuples(), entities) << field.name;
  for (vtkIdType i = 0; i < entities; ++i) {
    for (int k = 0; k < width; ++k) {
      const double wanted = k < field.components ? field.values[i * field.components + k] : 0.0;
      EXPECT_EQ(array->GetComponent(i, k), wanted) << field.name << " of " << i;
    }
  }
}

Field region_field(const Case<2>& c) {
  const std::vector<int>& regions = c.mesh.element_region;
  return {"region", "1", 1, {regions.begin(), regions.end()}, true};
}

TEST(Results, VtkReadsTheMesh) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "run.results");
  vtkNew<vtkHDFReader> reader;
  auto* grid = read_vtk(*reader, scratch / "run.results/snapshots/mesh_000001.hdf");
  ASSERT_NE(grid, nullptr);
  const Case<2> c = unit_square_case();
  ASSERT_EQ(grid->GetNumberOfCells(), c.mesh.element_count());
  ASSERT_EQ(grid->GetNumberOfPoints(), c.mesh.node_count());
  for (int i = 0; i < c.mesh.node_count(); ++i) {
    EXPECT_EQ(grid->GetPoint(i)[0], c.mesh.nodes[i][0]);
    EXPECT_EQ(grid->GetPoint(i)[1], c.mesh.nodes[i][1]);
    EXPECT_EQ(grid->GetPoint(i)[2], 0.0);
  }
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    EXPECT_EQ(grid->GetCellType(e), VTK_TRIANGLE);
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(grid->GetCell(e)->GetPointId(a), c.mesh.elements[e][a]);
    }
  }
  const Snapshot wanted = linear_snapshot(c, 10.0, 1);
  for (const auto& field : wanted.cell) {
    expect_array(grid->GetCellData()->GetArray(field.name.c_str()), field);
  }
  for (const auto& field : wanted.node) {
    expect_array(grid->GetPointData()->GetArray(field.name.c_str()), field);
  }
  expect_array(grid->GetCellData()->GetArray("region"), region_field(c));
}

TEST(Results, VtkReadsTheNamesOfTheRegions) {
  const ScratchFolder scratch;
  Case<2> c = unit_square_case();
  c.mesh.region_names = {"core/clay", "shell"};
  for (int e = 4; e < 8; ++e) c.mesh.element_region[e] = 1;
  ResultsWriter<2>(scratch / "run.results", c).write_snapshot(linear_snapshot(c, 0.0, 0));
  for (const std::string name : {"mesh_000000.hdf", "mesh_grid.hdf"}) {
    vtkNew<vtkHDFReader> reader;
    auto* grid = read_vtk(*reader, scratch / ("run.results/snapshots/" + name));
    for (const auto& [array, number] :
         {std::pair("region 0: core_clay", 0.0), std::pair("region 1: shell", 1.0)}) {
      vtkDataArray* const found = grid->GetFieldData()->GetArray(array);
      ASSERT_NE(found, nullptr) << array << " of " << name;
      ASSERT_EQ(found->GetNumberOfTuples(), 1);
      EXPECT_EQ(found->GetComponent(0, 0), number);
    }
    EXPECT_EQ(grid->GetCellData()->GetArray("region")->GetComponent(7, 0), 1.0);
  }
  const Hdf5File grid(scratch / "run.results/snapshots/mesh_grid.hdf", Hdf5File::Mode::read);
  EXPECT_EQ(grid.read_texts("/Suffuse/region_names"), c.mesh.region_names);
  // A link among them, which VTK would follow, is refused.
  const ResultsReader reader(scratch / "run.results");
  EXPECT_NO_THROW(static_cast<void>(reader.field_names(0, "cell")));
  Hdf5File(reader.snapshot_path("mesh", 0), Hdf5File::Mode::create)
      .link_to("/VTKHDF/FieldData/region 0: core_clay", "other.hdf");
  EXPECT_THROW(static_cast<void>(reader.field_names(0, "cell")), FileError);
}

TEST(Results, TheGridIsWrittenOnceAndReadFromAnywhere) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "run.results");
  const Case<2> c = unit_square_case();
  const ResultsReader reader(scratch / "run.results");
  expect_field(reader.field(2, "cell", "region"), region_field(c));
  EXPECT_EQ(reader.point_positions(1, "solid").size(), 8U);
  for (const char* kind : {"mesh", "solid"}) {
    const std::string grid = scratch / ("run.results/snapshots/" + std::string(kind) + "_grid.hdf");
    vtkNew<vtkHDFReader> alone;
    EXPECT_NE(read_vtk(*alone, grid), nullptr) << "a grid is a file for VTK itself";
    const std::string snapshot = reader.snapshot_path(kind, 1);
    const Hdf5File file(snapshot, Hdf5File::Mode::read);
    EXPECT_TRUE(file.is_in("/VTKHDF/Points", std::string(kind) + "_grid.hdf"));
  }
  // The folder can be moved, and can be read from another one.
  fs::rename(scratch / "run.results", scratch / "moved.results");
  const fs::path here = fs::current_path();
  for (const std::string& place : {std::string("/"), scratch / "moved.results"}) {
    fs::current_path(place);
    const fs::path path = fs::relative(scratch / "moved.results/snapshots/mesh_000001.hdf");
    vtkNew<vtkHDFReader> moved;
    auto* grid = read_vtk(*moved, path.string());
    EXPECT_EQ(grid->GetNumberOfPoints(), c.mesh.node_count());
    fs::current_path(here);
  }
}

TEST(Results, OtherLinksThanThatToTheGridAreRefused) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "run.results");
  const ResultsReader reader(scratch / "run.results");
  const std::string snapshot = reader.snapshot_path("solid", 1);
  for (const char* target : {"mesh_grid.hdf", "../snapshots/solid_grid.hdf", "/etc/passwd"}) {
    Hdf5File(snapshot, Hdf5File::Mode::create).link_to("/VTKHDF/Points", target);
    try {
      static_cast<void>(reader.point_positions(1, "solid"));
      FAIL() << "accepted " << target;
    } catch (const FileError& error) {
      EXPECT_EQ(
          std::string(error.what()),
          snapshot +
              ": /VTKHDF/Points: is a link; expected the object itself, as Suffuse writes it");
    }
  }
  // VTK would follow such links, so snapshots with them are refused, and so is a grid with one.
  EXPECT_THROW(static_cast<void>(reader.field_names(1, "solid")), FileError);
  EXPECT_NO_THROW(static_cast<void>(reader.field_names(0, "solid")));
  const std::string grid = scratch / "run.results/snapshots/solid_grid.hdf";
  Hdf5File(grid, Hdf5File::Mode::create).link_to("/VTKHDF/Points", "other.hdf");
  EXPECT_THROW(static_cast<void>(reader.field_names(0, "solid")), FileError);
  fs::remove(grid);
  EXPECT_THROW(static_cast<void>(reader.point_positions(0, "solid")), FileError);
}

TEST(Results, SevenDigitsWhereTheyAreAskedFor) {
  const ScratchFolder scratch;
  Case<2> c = unit_square_case();
  c.document.scene.output.precision = FieldPrecision::float32;
  Snapshot snapshot = linear_snapshot(c, 0.0, 0);
  snapshot.solid.push_back({"id", "1", 1, std::vector<double>(8, 16777217.0), true});
  const Field exact = snapshot.cell[0];
  ResultsWriter<2>(scratch / "run.results", c).write_snapshot(snapshot);
  const ResultsReader reader(scratch / "run.results");
  const Field read = reader.field(0, "cell", exact.name);
  for (std::size_t i = 0; i < exact.values.size(); ++i) {
    EXPECT_EQ(read.values[i], static_cast<double>(static_cast<float>(exact.values[i])));
  }
  EXPECT_NE(read.values, exact.values);
  EXPECT_EQ(reader.field(0, "solid", "id").values[0], 16777217.0);
  vtkNew<vtkHDFReader> vtk;
  auto* grid = read_vtk(*vtk, reader.snapshot_path("mesh", 0));
  EXPECT_EQ(grid->GetCellData()->GetArray(exact.name.c_str())->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(grid->GetPoint(4)[0], c.mesh.nodes[4][0]) << "places keep all digits";
}

TEST(Results, VtkReadsTheSolidPoints) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "run.results");
  vtkNew<vtkHDFReader> reader;
  auto* grid = read_vtk(*reader, scratch / "run.results/snapshots/solid_000002.hdf");
  ASSERT_NE(grid, nullptr);
  const Case<2> c = unit_square_case();
  ASSERT_EQ(grid->GetNumberOfCells(), 8);
  for (int p = 0; p < 8; ++p) {
    EXPECT_EQ(grid->GetCellType(p), VTK_VERTEX);
    EXPECT_NEAR(grid->GetPoint(p)[0], element_centroid(c.mesh, p)[0], 1e-15);
    EXPECT_NEAR(grid->GetPoint(p)[1], element_centroid(c.mesh, p)[1], 1e-15);
  }
  expect_array(grid->GetPointData()->GetArray("porosity"), linear_snapshot(c, 40.0, 2).solid[0]);
}

TEST(Results, ParaViewShowsTheTimes) {
  if (std::system("command -v pvbatch > /dev/null 2>&1") != 0) GTEST_SKIP() << "no pvbatch";
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "run.results");
  const std::string script = scratch / "times.py";
  const std::string answer = scratch / "answer.txt";
  std::ofstream(script) << "from paraview.simple import *\n"
                        << "reader = OpenDataFile('" << scratch / "run.results/mesh.hdf.series"
                        << "')\nreader.UpdatePipelineInformation()\n"
                        << "open('" << answer << "', 'w').write(' '.join(str(float(t)) for t in "
                        << "reader.TimestepValues))\n";
  ASSERT_EQ(std::system(("pvbatch " + script + " > /dev/null").c_str()), 0);
  EXPECT_EQ(file_text(answer), "0.0 10.0 40.0");
}

TEST(Results, AnEarlierRunIsReplaced) {
  const ScratchFolder scratch;
  const std::string folder = scratch / "run.results";
  write_synthetic_results(folder);
  std::ofstream(folder + "/notes.txt") << "mine";
  const Case<2> other = unit_square_case("synthetic", "constant", 2e-3);
  EXPECT_THROW((ResultsWriter<2>(folder, other)), InputError) << "of the same name";
  EXPECT_TRUE(fs::exists(folder + "/snapshots/mesh_000000.hdf"));
  const Case<2> c = unit_square_case();
  const ResultsWriter<2> writer(folder, c);
  EXPECT_FALSE(fs::exists(folder + "/snapshots/mesh_000000.hdf"));
  EXPECT_FALSE(fs::exists(folder + "/mesh.hdf.series"));
  EXPECT_EQ(file_text(folder + "/notes.txt"), "mine");
  const ResultsReader reader(folder);
  EXPECT_EQ(reader.status(), "running");
  EXPECT_TRUE(reader.times().empty());
  EXPECT_EQ(reader.history().rows(), 0U);
}

TEST(Results, AStrangersFolderIsNotTouched) {
  const ScratchFolder scratch;
  const std::string folder = scratch / "photos";
  fs::create_directories(folder);
  std::ofstream(folder + "/history.csv") << "of my family\n";
  const Case<2> c = unit_square_case();
  try {
    const ResultsWriter<2> writer(folder, c);
    FAIL() << "accepted";
  } catch (const FileError& error) {
    EXPECT_EQ(std::string(error.what()),
              folder +
                  ": is not empty and holds no results of suffuse-solver; not touched: choose "
                  "another folder or empty it");
  }
  EXPECT_EQ(file_text(folder + "/history.csv"), "of my family\n");
  EXPECT_FALSE(fs::exists(folder + "/run.json"));
}

TEST(Results, ARowBeingWrittenIsNotThereYet) {
  const ScratchFolder scratch;
  const std::string path = scratch / "table.csv";
  std::ofstream(path) << "a,b\n1,2\n3,4";
  EXPECT_EQ(read_table(path).rows(), 1U);
}

TEST(Results, ABadNumberIsNamedWithItsLine) {
  const ScratchFolder scratch;
  const std::string path = scratch / "table.csv";
  std::ofstream(path) << "a,b\n1,2\n3,x4\n";
  try {
    read_table(path);
    FAIL() << "accepted";
  } catch (const FileError& error) {
    EXPECT_EQ(std::string(error.what()), path + ":3: b: got 'x4'; expected a number");
  }
}

/// Spreadsheets in countries with decimal commas write such tables.
TEST(Results, OtherSeparatorsAreNamed) {
  const ScratchFolder scratch;
  const std::string path = scratch / "table.csv";
  const auto message = [&](const std::string& text) {
    std::ofstream(path) << text;
    try {
      read_table(path);
    } catch (const FileError& error) {
      return std::string(error.what()).substr(path.size());
    }
    return std::string("accepted");
  };
  const std::string commas = ", with commas between columns in the place of ";
  EXPECT_EQ(message("t;head\n0;2,5\n"), ":1: got t;head; expected a line of names" + commas +
                                            "semicolons, and decimal points in numbers");
  EXPECT_EQ(message("t,head\n0;2.5\n"),
            ":2: got 1 columns; expected 2" + commas + "semicolons, and decimal points in numbers");
  EXPECT_EQ(message("t,head\n0\t2.5\n"),
            ":2: got 1 columns; expected 2" + commas + "tabs, and decimal points in numbers");
  EXPECT_EQ(message("t,head\n0,2,5\n"),
            ":2: got 3 columns; expected 2, with decimal points in numbers");
  EXPECT_EQ(message("t,head\n0\n"), ":2: got 1 columns; expected 2");
  EXPECT_EQ(message("t,head\n0,2.5\n"), "accepted");
}

}  // namespace results_test
}  // namespace suffuse
