/// What the reader of results says about damaged folders.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <functional>
#include <string>

#include "bytes.hpp"
#include "common/errors.hpp"
#include "edited_files.hpp"
#include "results/reader.hpp"

namespace suffuse::fuzz {
namespace damaged_results_test {

std::string failure(const std::function<void()>& body) {
  try {
    body();
  } catch (const FileError& error) {
    return error.what();
  }
  return "nothing refused";
}

/// Reads everything in the folder that a script makes; returns the message of the failure.
std::string reading_failure(const std::string& script) {
  const std::string folder = lay_out_results(script);
  std::string message = failure([&] {
    const ResultsReader results(folder);
    static_cast<void>(results.history());
    static_cast<void>(results.ledger());
    static_cast<void>(results.field(1, "cell", "porosity"));
    static_cast<void>(results.field(1, "node", "liquid_velocity"));
    static_cast<void>(results.field(1, "element_vertex", "concentration"));
    static_cast<void>(results.field(1, "liquid", "concentration"));
    static_cast<void>(results.point_positions(1, "liquid"));
  });
  if (message.starts_with(folder + "/")) message.erase(0, folder.size() + 1);
  return message;
}

struct Damage {
  std::string name;
  std::string script;
  std::string message;  // beginning of the message
};

void PrintTo(const Damage& damage, std::ostream* stream) {
  *stream << damage.name;
}

class DamagedResults : public testing::TestWithParam<Damage> {};

TEST_P(DamagedResults, AreRefusedWithTheirReason) {
  const std::string message = reading_failure("seed double-point\n" + GetParam().script);
  EXPECT_EQ(message.substr(0, GetParam().message.size()), GetParam().message) << message;
}

const std::string mesh_1 = "in snapshots/mesh_000001.hdf\n";
const std::string liquid_1 = "in snapshots/liquid_000001.hdf\n";

INSTANTIATE_TEST_SUITE_P(
    All, DamagedResults,
    testing::Values(
        Damage{"None", "", "nothing refused"},
        Damage{"FolderForRunInfo", "in run.json\nfolder", "run.json: cannot be read"},
        Damage{"FolderForSeries", "in mesh.hdf.series\nfolder", "mesh.hdf.series: cannot be read"},
        Damage{"FolderForTable", "in history.csv\nfolder", "history.csv: cannot be read"},
        Damage{"TruncatedRunInfo", "in run.json\ncut 100", "run.json: is not JSON"},
        Damage{"OtherVersion", "json /format_version \"\xff\"", "run.json: got format_version"},
        Damage{"Scene", "json /scene/text \"formulation = 3\"",
               "run.json: the scene within is not valid:\n"},
        Damage{
            "SnapshotElsewhere", "in mesh.hdf.series\njson /files/1/name \"/etc/passwd\"",
            "mesh.hdf.series: snapshot 1: got the file \"/etc/passwd\"; expected one in snapshots"},
        Damage{"SnapshotAbove",
               "in mesh.hdf.series\njson /files/1/name \"snapshots/../../other/a.hdf\"",
               "mesh.hdf.series: snapshot 1: got the file \"snapshots/../../other/a.hdf\""},
        Damage{"TimeGoesBack", "in mesh.hdf.series\njson /files/1/time -1.5",
               "mesh.hdf.series: snapshot 1: got t = -1.5 s; expected a later time than the one "
               "before, 0 s"},
        Damage{"ValuesOfAnotherMesh", mesh_1 + "shape /VTKHDF/CellData/porosity 23",
               "snapshots/mesh_000001.hdf: /VTKHDF/CellData/porosity: got values for 23 of 24; the "
               "snapshot is not of this run's mesh and points, or damaged"},
        Damage{
            "ValuesOfFewerNodes", mesh_1 + "shape /VTKHDF/PointData/liquid_velocity 3 3",
            "snapshots/mesh_000001.hdf: /VTKHDF/PointData/liquid_velocity: got values for 3 of 21"},
        Damage{"NoComponents", mesh_1 + "attribute /VTKHDF/CellData/porosity components i64 0",
               "snapshots/mesh_000001.hdf: /VTKHDF/CellData/porosity: its shape is not that of 0 "
               "components"},
        Damage{"ManyComponents",
               mesh_1 + "attribute /VTKHDF/CellData/porosity components i64 4294967297",
               "snapshots/mesh_000001.hdf: /VTKHDF/CellData/porosity: its shape is not that of "
               "4294967297 components"},
        Damage{"WidthOfElements", mesh_1 + "shape /Suffuse/element_vertex/concentration 24 2",
               "snapshots/mesh_000001.hdf: /Suffuse/element_vertex/concentration: its shape"},
        Damage{"FlatPositions", liquid_1 + "shape /VTKHDF/Points 10",
               "snapshots/liquid_000001.hdf: /VTKHDF/Points: expected a table of 3 columns"},
        Damage{"Absurd", mesh_1 + "claim /VTKHDF/CellData/porosity chunked 1000000000000",
               "snapshots/mesh_000001.hdf: /VTKHDF/CellData/porosity: its shape [1000000000000] is "
               "larger than what the file holds"},
        Damage{"NoDimension", "json /dimension 4", "run.json: dimension: got 4; expected 2 or 3"},
        Damage{"NoSnapshot", mesh_1 + "delete", "snapshots/mesh_000001.hdf: there is no such file"},
        Damage{"FolderForSnapshot", mesh_1 + "folder", "snapshots/mesh_000001.hdf: is not a file"}),
    [](const auto& tested) { return tested.param.name; });

TEST(DamagedResults, DeepJsonIsRefused) {
  const std::string folder = lay_out_results("");
  for (const std::string begin : {"[", "{\"a\":"}) {
    std::string deep;
    for (int i = 0; i < 300000; ++i) deep += begin;
    write_bytes(folder + "/run.json", deep);
    EXPECT_EQ(failure([&] { const ResultsReader results(folder); }),
              folder + "/run.json: is not JSON");
    write_bytes(folder + "/run.json", std::string(300000, '[') + std::string(300000, ']'));
    EXPECT_EQ(failure([&] { const ResultsReader results(folder); }),
              folder + "/run.json: was not written by suffuse-solver");
  }
}

TEST(DamagedResults, APipeIsNotWaitedFor) {
  const std::string folder = lay_out_results("in history.csv\ndelete");
  ASSERT_EQ(::mkfifo((folder + "/history.csv").c_str(), 0600), 0);
  const ResultsReader results(folder);
  EXPECT_EQ(failure([&] { static_cast<void>(results.history()); }),
            folder + "/history.csv: cannot be read");
}

}  // namespace damaged_results_test
}  // namespace suffuse::fuzz
