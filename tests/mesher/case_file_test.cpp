#include "case/case_file.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/stat.h>

#include <chrono>
#include <functional>
#include <limits>
#include <thread>

#include "common/errors.hpp"
#include "common/hdf5_io.hpp"
#include "common/pending_file.hpp"
#include "temporary_folder.hpp"

namespace suffuse {
namespace case_file_test {

using test::read_file;
using test::TemporaryFolder;

/// The unit square in two triangles, three points each.
Case<2> small_case() {
  Case<2> c;
  c.document = parse_scene(
      test::scene_text(test::unit_column, "[[boundary]]\non = \"top\"\npressure = 1.0\n"),
      "folder/test.toml", {"points.solid_per_element=3"});
  c.mesh.nodes = {{0, 0}, {1, 0}, {1, 1}, {0.1, 1.0 / 3.0}};
  c.mesh.elements = {{0, 1, 2}, {0, 2, 3}};
  c.mesh.element_region = {0, 0};
  c.mesh.region_names = {"specimen"};
  c.mesh.boundaries = {{"top", {{2, 3}}}, {"sides", {{1, 2}, {0, 3}}}};
  for (int e = 0; e < 2; ++e) {
    for (int a = 0; a < 3; ++a) {
      std::array<double, 3> at{1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0};
      at[a] = 2.0 / 3.0;
      c.solid_points.element.push_back(e);
      c.solid_points.barycentric.push_back(at);
      c.solid_points.volume.push_back(element_volume(c.mesh, e) / 3.0);
    }
  }
  return c;
}

/// `small_case` as a double-point case: the second element is free water, and each element has two
/// liquid points.
Case<2> double_point_case() {
  Case<2> c = small_case();
  c.document = parse_scene(c.document.text, c.document.path, {"formulation=double-point"});
  c.mesh.element_region = {0, 1};
  c.mesh.region_names = {"specimen", "inflow"};
  c.solid_points.element.resize(3);
  c.solid_points.volume.resize(3);
  c.solid_points.barycentric.resize(3);
  c.liquid_points.element = {0, 0, 1, 1};
  c.liquid_points.barycentric = {
      {0.25, 0.25, 0.5}, {0.5, 0.125, 0.375}, {0.125, 0.75, 0.125}, {0.1, 0.2, 0.7}};
  c.liquid_points.volume = {0.05, 0.1, 0.1, 1.0 / 60.0};
  return c;
}

TEST(CaseFile, ReadsBackExactlyWhatWasWritten) {
  const TemporaryFolder folder;
  const Case<2> written = small_case();
  write_case(folder.file("a.case.h5"), written);
  EXPECT_EQ(folder.count(), 1);  // no temporary file is left
  EXPECT_EQ(read_case_dimension(folder.file("a.case.h5")), 2);

  const Case<2> read = read_case<2>(folder.file("a.case.h5"));
  EXPECT_EQ(read.mesh.nodes, written.mesh.nodes);
  EXPECT_EQ(read.mesh.elements, written.mesh.elements);
  EXPECT_EQ(read.mesh.element_region, written.mesh.element_region);
  EXPECT_EQ(read.mesh.region_names, written.mesh.region_names);
  ASSERT_EQ(read.mesh.boundaries.size(), 2U);
  EXPECT_EQ(read.mesh.boundaries[1].name, "sides");
  EXPECT_EQ(read.mesh.boundaries[1].faces, written.mesh.boundaries[1].faces);
  EXPECT_EQ(read.solid_points.element, written.solid_points.element);
  EXPECT_EQ(read.solid_points.barycentric, written.solid_points.barycentric);
  EXPECT_EQ(read.solid_points.volume, written.solid_points.volume);
  EXPECT_EQ(read.document.text, written.document.text);
  EXPECT_EQ(read.document.path, "folder/test.toml");
  EXPECT_EQ(read.document.overrides, written.document.overrides);
  EXPECT_EQ(read.document.scene.liquid.bulk_modulus, 2.0e7);
}

/// The case may be moved and the file may change, so the case has a copy of the file.
TEST(CaseFile, BringsTheTablesThatTheSceneNames) {
  const TemporaryFolder folder;
  Case<2> written = small_case();
  const std::map<std::string, std::string> files{{"flood.csv", "t,head\n0,1\n10,2.5\n"}};
  written.document = parse_scene(written.document.text, written.document.path,
                                 {"boundary=[{on=\"top\", file=\"flood.csv\"}]"}, files);
  write_case(folder.file("a.h5"), written);
  const Case<2> read = read_case<2>(folder.file("a.h5"));
  EXPECT_EQ(read.document.files, files);
  const std::vector<std::pair<double, double>> knots{{0.0, 1.0}, {10.0, 2.5}};
  EXPECT_EQ(read.document.scene.boundaries[0].head, TimeFunction(knots));
  write_case(folder.file("b.h5"), small_case());
  EXPECT_FALSE(Hdf5File(folder.file("b.h5"), Hdf5File::Mode::read).exists("/scene/file_names"));
}

TEST(CaseFile, ReadsBackLiquidPoints) {
  const TemporaryFolder folder;
  const Case<2> written = double_point_case();
  write_case(folder.file("a.h5"), written);
  const Case<2> read = read_case<2>(folder.file("a.h5"));
  EXPECT_EQ(read.solid_points.element, written.solid_points.element);
  EXPECT_EQ(read.liquid_points.element, written.liquid_points.element);
  EXPECT_EQ(read.liquid_points.barycentric, written.liquid_points.barycentric);
  EXPECT_EQ(read.liquid_points.volume, written.liquid_points.volume);
  const Hdf5File file(folder.file("a.h5"), Hdf5File::Mode::read);
  EXPECT_EQ(file.text_attribute("/liquid_points/volume", "unit"), "m3/m");
}

TEST(CaseFile, HasLiquidPointsInDoublePointCasesOnly) {
  const TemporaryFolder folder;
  Case<2> c = small_case();
  c.liquid_points = double_point_case().liquid_points;
  write_case(folder.file("a.h5"), c);
  EXPECT_FALSE(Hdf5File(folder.file("a.h5"), Hdf5File::Mode::read).exists("/liquid_points"));
  EXPECT_EQ(read_case<2>(folder.file("a.h5")).liquid_points.size(), 0);
}

TEST(CaseFile, EqualCasesAreEqualFiles) {
  const TemporaryFolder folder;
  write_case(folder.file("a.h5"), small_case());
  write_case(folder.file("b.h5"), small_case());
  EXPECT_EQ(read_file(folder.file("a.h5")), read_file(folder.file("b.h5")));
}

TEST(CaseFile, MoreThanTenBoundariesKeepTheirOrder) {
  const TemporaryFolder folder;
  Case<2> c = small_case();
  for (int i = 0; i < 12; ++i) c.mesh.boundaries.push_back({"b" + std::to_string(i), {{0, 1}}});
  write_case(folder.file("a.h5"), c);
  const Case<2> read = read_case<2>(folder.file("a.h5"));
  for (std::size_t i = 0; i < 14; ++i) {
    EXPECT_EQ(read.mesh.boundaries[i].name, c.mesh.boundaries[i].name);
  }
}

std::string failure(const std::function<void()>& body) {
  try {
    body();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no FileError";
}

std::string reading_failure(const std::string& path) {
  return failure([&] { static_cast<void>(read_case<2>(path)); });
}

TEST(CaseFile, AnOldFileSurvivesAFailedWrite) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  write_case(path, small_case());
  const std::string before = read_file(path);
  Case<2> bad = small_case();
  bad.solid_points.volume.pop_back();
  bad.solid_points.barycentric.pop_back();
  EXPECT_NE(failure([&] { write_case(path, bad); }).find("do not fill the shape"),
            std::string::npos);
  EXPECT_EQ(read_file(path), before);
  EXPECT_EQ(folder.count(), 1);
}

TEST(PendingFile, APipeGetsTheContentsAndStaysAPipe) {
  const TemporaryFolder folder;
  const std::string path = folder.file("pipe");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::string received;
  std::thread reader([&] { received = read_file(path); });
  std::string temporary;
  {
    PendingFile file(path);
    temporary = file.temporary_path();
    std::ofstream(temporary) << "t,c\n";
    file.commit();
  }
  reader.join();
  EXPECT_EQ(received, "t,c\n");
  EXPECT_TRUE(std::filesystem::is_fifo(path));
  EXPECT_FALSE(std::filesystem::exists(temporary));
  EXPECT_EQ(folder.count(), 1);
}

TEST(CaseFile, AMissingFolderIsNamed) {
  EXPECT_EQ(failure([] { write_case("/nowhere/at/all/a.case.h5", small_case()); }),
            "/nowhere/at/all/a.case.h5: cannot be created: there is no folder /nowhere/at/all");
}

TEST(CaseFile, OtherFilesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(reading_failure(folder.file("none.h5")),
            folder.file("none.h5") + ": there is no such file");
  const std::string text = folder.write("text.h5", "not HDF5 at all");
  EXPECT_EQ(reading_failure(text), text + ": is not an HDF5 file; expected one that Suffuse wrote");
  EXPECT_EQ(reading_failure(folder.path().string()), folder.path().string() + ": is not a file");
  const std::string other = folder.file("other.h5");
  Hdf5File(other, Hdf5File::Mode::create).write_text("/text", "hello");
  EXPECT_EQ(reading_failure(other),
            other + ": is not a case file; expected what suffuse-mesher writes");
}

TEST(CaseFile, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  write_case(path, double_point_case());
  const std::string whole = read_file(path);
  for (std::size_t length = 0; length < whole.size(); length += 997) {
    const std::string cut = folder.write("cut.h5", whole.substr(0, length));
    EXPECT_NE(reading_failure(cut), "no FileError") << length << " bytes";
  }
}

TEST(CaseFile, DamagedBytesNeverCrash) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  write_case(path, double_point_case());
  const std::string whole = read_file(path);
  for (std::size_t at = 0; at < whole.size(); at += 61) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(~damaged[at]);
    const std::string file = folder.write("damaged.h5", damaged);
    try {
      static_cast<void>(read_case<2>(file));  // some bytes are unused
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos);
    }
  }
}

TEST(CaseFile, DamageWhereThingsAreSaidIsNoticed) {
  // The first 48 bytes are the superblock; headers of objects follow, each with a checksum.
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  write_case(path, small_case());
  const std::string whole = read_file(path);
  for (std::size_t at = 0; at < 48; ++at) {
    for (const int bit : {0, 3, 7}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
      EXPECT_NE(reading_failure(folder.write("damaged.h5", damaged)), "no FileError") << at;
    }
  }
  std::size_t headers = 0;
  for (std::size_t at = whole.find("OHDR"); at != std::string::npos;
       at = whole.find("OHDR", at + 1)) {
    ++headers;
    std::string damaged = whole;
    damaged[at + 6] = static_cast<char>(~damaged[at + 6]);
    EXPECT_NE(reading_failure(folder.write("damaged.h5", damaged)), "no FileError") << at;
  }
  EXPECT_GT(headers, 10U);
}

TEST(CaseFile, ALayoutWithoutChecksumsIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.file("old.h5");
  H5Fclose(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  EXPECT_NE(reading_failure(path).find("first of HDF5's file layouts, which has no checksums; "
                                       "write it anew with Suffuse, or convert it: h5repack"),
            std::string::npos);
}

TEST(CaseFile, EqualCasesAreEqualFilesAtAnyTime) {
  const TemporaryFolder folder;
  write_case(folder.file("a.h5"), small_case());
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 stores times in seconds
  write_case(folder.file("b.h5"), small_case());
  EXPECT_EQ(read_file(folder.file("a.h5")), read_file(folder.file("b.h5")));
}

/// Changes one value of a dataset in place.
template <class Value>
void overwrite(const std::string& path, const std::string& dataset, hid_t type, hsize_t index,
               Value value) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t set = H5Dopen2(file, dataset.c_str(), H5P_DEFAULT);
  const hid_t space = H5Dget_space(set);
  const hsize_t total = static_cast<hsize_t>(H5Sget_simple_extent_npoints(space));
  std::vector<Value> values(total);
  ASSERT_GE(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  values.at(index) = value;
  ASSERT_GE(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
}

void set_integer(const std::string& path, const std::string& dataset, hsize_t index, int value) {
  overwrite(path, dataset, H5T_NATIVE_INT, index, value);
}

void set_double(const std::string& path, const std::string& dataset, hsize_t index, double value) {
  overwrite(path, dataset, H5T_NATIVE_DOUBLE, index, value);
}

/// Removes an object, so that others can take its place.
void remove_object(const std::string& path, const std::string& object) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Ldelete(file, object.c_str(), H5P_DEFAULT), 0);
  H5Fclose(file);
}

/// Makes a dataset that claims `rows` x 2 doubles and holds none.
void claim_rows(const std::string& path, const std::string& dataset, hsize_t rows) {
  remove_object(path, dataset);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const std::array<hsize_t, 2> extents{rows, 2};
  const std::array<hsize_t, 2> chunk{1024, 2};
  const hid_t space = H5Screate_simple(2, extents.data(), nullptr);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(creation, 2, chunk.data());
  const hid_t set = H5Dcreate2(file, dataset.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT,
                               creation, H5P_DEFAULT);
  ASSERT_GE(set, 0);
  H5Dclose(set);
  H5Pclose(creation);
  H5Sclose(space);
  H5Fclose(file);
}

void replace_text(const std::string& path, const std::string& dataset, const std::string& text) {
  remove_object(path, dataset);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, text.size());
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t set =
      H5Dcreate2(file, dataset.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), 0);
  H5Dclose(set);
  H5Sclose(space);
  H5Tclose(type);
  H5Fclose(file);
}

void set_attribute(const std::string& path, const std::string& name, std::int64_t value) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t group = H5Gopen2(file, "/suffuse", H5P_DEFAULT);
  const hid_t attribute = H5Aopen(group, name.c_str(), H5P_DEFAULT);
  ASSERT_GE(H5Awrite(attribute, H5T_NATIVE_INT64, &value), 0);
  H5Aclose(attribute);
  H5Gclose(group);
  H5Fclose(file);
}

void create_group(const std::string& path, const std::string& group) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t made = H5Gcreate2(file, group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(made, 0);
  H5Gclose(made);
  H5Fclose(file);
}

/// Makes `object` a link to another object, in this file or in another one.
void replace_by_link(const std::string& path, const std::string& object, const std::string& target,
                     const std::string& other_file = "") {
  remove_object(path, object);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const herr_t made =
      other_file.empty()
          ? H5Lcreate_soft(target.c_str(), file, object.c_str(), H5P_DEFAULT, H5P_DEFAULT)
          : H5Lcreate_external(other_file.c_str(), target.c_str(), file, object.c_str(),
                               H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(made, 0);
  H5Fclose(file);
}

/// Makes a dataset of `rows` x 2 doubles whose values are in another file.
void keep_elsewhere(const std::string& path, const std::string& dataset, hsize_t rows,
                    bool is_virtual) {
  remove_object(path, dataset);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const std::array<hsize_t, 2> extents{rows, 2};
  const hid_t space = H5Screate_simple(2, extents.data(), nullptr);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  if (is_virtual) {
    H5Pset_virtual(creation, space, "/dev/zero", "/nodes", space);
  } else {
    H5Pset_external(creation, "/dev/zero", 0, rows * 16);
  }
  const hid_t set = H5Dcreate2(file, dataset.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT,
                               creation, H5P_DEFAULT);
  ASSERT_GE(set, 0);
  H5Dclose(set);
  H5Pclose(creation);
  H5Sclose(space);
  H5Fclose(file);
}

void make_null(const std::string& path, const std::string& dataset) {
  remove_object(path, dataset);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t space = H5Screate(H5S_NULL);
  const hid_t set = H5Dcreate2(file, dataset.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT,
                               H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(set, 0);
  H5Dclose(set);
  H5Sclose(space);
  H5Fclose(file);
}

/// Replaces a dataset by a copy of another one.
void replace_by_copy(const std::string& path, const std::string& dataset, const std::string& by) {
  remove_object(path, dataset);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Ocopy(file, by.c_str(), file, dataset.c_str(), H5P_DEFAULT, H5P_DEFAULT), 0);
  H5Fclose(file);
}

struct Damage {
  std::string name;
  std::function<void(const std::string&)> apply;
  std::string message;
};

void PrintTo(const Damage& damage, std::ostream* stream) {
  *stream << damage.name;
}

void expect_refusal(const Case<2>& c, const Damage& damage) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  write_case(path, c);
  damage.apply(path);
  const std::string message = reading_failure(path);
  EXPECT_EQ(message.find(path + ": "), 0U) << message;
  EXPECT_NE(message.find(damage.message), std::string::npos) << message;
}

class DamagedCase : public testing::TestWithParam<Damage> {};

TEST_P(DamagedCase, IsRefusedWithItsReason) {
  expect_refusal(small_case(), GetParam());
}

class DamagedDoublePointCase : public testing::TestWithParam<Damage> {};

TEST_P(DamagedDoublePointCase, IsRefusedWithItsReason) {
  expect_refusal(double_point_case(), GetParam());
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    All, DamagedCase,
    testing::Values(
        Damage{"NodeIndex", [](auto& f) { set_integer(f, "/mesh/elements", 4, 99); },
               "/mesh/elements: value 4 is 99; expected 0 to 3"},
        Damage{"NegativeIndex", [](auto& f) { set_integer(f, "/mesh/elements", 0, -1); },
               "value 0 is -1"},
        Damage{"Region", [](auto& f) { set_integer(f, "/mesh/element_region", 0, 1); },
               "/mesh/element_region: value 0 is 1"},
        Damage{"NodeNotFinite", [](auto& f) { set_double(f, "/mesh/nodes", 3, nan); },
               "/mesh/nodes: node 1 is not finite"},
        Damage{"Clockwise", [](auto& f) { set_double(f, "/mesh/nodes", 3, 9.0); },
               "/mesh/elements: element 0 has no positive volume"},
        Damage{"UnusedNode", [](auto& f) { set_integer(f, "/mesh/elements", 1, 3); }, "element 0"},
        Damage{"InnerFace", [](auto& f) { set_integer(f, "/boundaries/0/faces", 1, 0); },
               "a face of \"top\" is not an outer face"},
        Damage{"PointOwner", [](auto& f) { set_integer(f, "/solid_points/element", 5, 2); },
               "/solid_points/element: value 5 is 2; expected 0 to 1"},
        Damage{"Unsorted", [](auto& f) { set_integer(f, "/solid_points/element", 0, 1); },
               "expected points sorted by element"},
        Damage{"BarycentricSum",
               [](auto& f) { set_double(f, "/solid_points/barycentric", 4, 0.7); },
               "the coordinates of point 1 do not lie in its element"},
        Damage{"BarycentricNan",
               [](auto& f) { set_double(f, "/solid_points/barycentric", 4, nan); }, "point 1"},
        Damage{"NegativeVolume", [](auto& f) { set_double(f, "/solid_points/volume", 2, -1.0); },
               "the volume of point 2 is not positive"},
        Damage{"InfiniteVolume",
               [](auto& f) {
                 set_double(f, "/solid_points/volume", 2, std::numeric_limits<double>::infinity());
               },
               "the volume of point 2 is not positive and finite"},
        Damage{"VolumesDoNotFill", [](auto& f) { set_double(f, "/solid_points/volume", 2, 1e-3); },
               "/solid_points/volume: the volumes of the points in element 0 at ("},
        Damage{"Missing", [](auto& f) { remove_object(f, "/solid_points/volume"); },
               "/solid_points/volume: is missing"},
        Damage{"NoBoundaries", [](auto& f) { remove_object(f, "/boundaries"); },
               "/boundaries: is missing or not a group"},
        Damage{"MissingBoundary", [](auto& f) { remove_object(f, "/boundaries/0"); },
               "/boundaries/0/name: is missing"},
        Damage{"Absurd", [](auto& f) { claim_rows(f, "/mesh/nodes", hsize_t{1} << 50U); },
               "/mesh/nodes: its shape [1125899906842624, 2] is larger than what the file holds"},
        Damage{"WrongType", [](auto& f) { replace_text(f, "/mesh/nodes", "text"); },
               "/mesh/nodes: holds text; expected floating-point numbers"},
        Damage{"Link", [](auto& f) { replace_by_link(f, "/solid_points", "/mesh"); },
               "/solid_points: is a link; expected the object itself"},
        Damage{"LinkToAnotherFile",
               [](auto& f) { replace_by_link(f, "/mesh/nodes", "/nodes", "/dev/zero"); },
               "/mesh/nodes: is a link; expected the object itself"},
        Damage{"ValuesElsewhere", [](auto& f) { keep_elsewhere(f, "/mesh/nodes", 4, false); },
               "/mesh/nodes: has its values in another file"},
        Damage{"VirtualValues", [](auto& f) { keep_elsewhere(f, "/mesh/nodes", 4, true); },
               "/mesh/nodes: has its values in another file"},
        Damage{"Null", [](auto& f) { make_null(f, "/mesh/nodes"); },
               "/mesh/nodes: expected a table of 2 columns"},
        Damage{"BrokenScene", [](auto& f) { replace_text(f, "/scene/text", "formulation = 3"); },
               "/scene: the scene within is not valid"},
        Damage{
            "OtherBoundary", [](auto& f) { replace_text(f, "/boundaries/0/name", "tip"); },
            "boundary[0].on: got \"top\"; expected a boundary of the mesh: \"tip\" or \"sides\""},
        Damage{"TwiceTheSameName", [](auto& f) { replace_text(f, "/boundaries/0/name", "sides"); },
               "expected names that differ"},
        Damage{"Version", [](auto& f) { set_attribute(f, "schema_version", 1); },
               "is a case file of schema version 1; this program reads version 2"},
        Damage{"LiquidPoints", [](auto& f) { create_group(f, "/liquid_points"); },
               "/liquid_points: the scene is single-point; expected no liquid points"},
        Damage{"Dimension", [](auto& f) { set_attribute(f, "dimension", 3); },
               "is a case of dimension 3; expected 2"},
        Damage{"NoDimension", [](auto& f) { set_attribute(f, "dimension", 4); },
               "its dimension is 4"}),
    [](const auto& tested) { return tested.param.name; });

INSTANTIATE_TEST_SUITE_P(
    All, DamagedDoublePointCase,
    testing::Values(
        Damage{"NoLiquid", [](auto& f) { remove_object(f, "/liquid_points"); },
               "/liquid_points/element: is missing"},
        Damage{"Missing", [](auto& f) { remove_object(f, "/liquid_points/volume"); },
               "/liquid_points/volume: is missing"},
        Damage{"Lengths",
               [](auto& f) { replace_by_copy(f, "/liquid_points/volume", "/solid_points/volume"); },
               "/liquid_points: element, barycentric and volume differ in length"},
        Damage{"Owner", [](auto& f) { set_integer(f, "/liquid_points/element", 3, 2); },
               "/liquid_points/element: value 3 is 2; expected 0 to 1"},
        Damage{"Unsorted", [](auto& f) { set_integer(f, "/liquid_points/element", 0, 1); },
               "/liquid_points/element: expected points sorted by element"},
        Damage{"Barycentric", [](auto& f) { set_double(f, "/liquid_points/barycentric", 4, 0.7); },
               "/liquid_points/barycentric: the coordinates of point 1 do not lie in its element"},
        Damage{"Volume", [](auto& f) { set_double(f, "/liquid_points/volume", 2, 0.0); },
               "/liquid_points/volume: the volume of point 2 is not positive"},
        Damage{"VolumeNan", [](auto& f) { set_double(f, "/liquid_points/volume", 2, nan); },
               "/liquid_points/volume: the volume of point 2 is not positive and finite"},
        Damage{"ElementWithoutPoints",
               [](auto& f) {
                 set_integer(f, "/liquid_points/element", 2, 0);
                 set_integer(f, "/liquid_points/element", 3, 0);
               },
               "/liquid_points/volume: the volumes of the points in element 0 at ("},
        Damage{"VolumesDoNotFill",
               [](auto& f) { set_double(f, "/liquid_points/volume", 2, 0.1 * (1.0 + 1e-6)); },
               "/liquid_points/volume: the volumes of the points in element 1 at ("},
        Damage{"WrongType", [](auto& f) { replace_text(f, "/liquid_points/volume", "text"); },
               "/liquid_points/volume: holds text; expected floating-point numbers"},
        Damage{"SolidInFreeWater", [](auto& f) { set_integer(f, "/solid_points/element", 2, 1); },
               "/solid_points/element: point 2 lies in \"inflow\", which is free water"}),
    [](const auto& tested) { return tested.param.name; });

TEST(Hdf5File, TextsAndAttributesComeBack) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  const std::vector<std::string> texts{"", "Böschung", "two\nlines"};
  {
    Hdf5File file(path, Hdf5File::Mode::create);
    file.write_texts("/deep/down/texts", texts);
    file.write_texts("/none", {});
    file.write("/empty", std::span<const double>(), {0, 3});
    file.attribute("/deep", "name", std::string("Böschung"));
    file.attribute("/deep", "empty", std::string());
    file.attribute("/deep", "value", 0.1);
    file.close();
  }
  const Hdf5File file(path, Hdf5File::Mode::read);
  EXPECT_EQ(file.read_texts("/deep/down/texts"), texts);
  EXPECT_TRUE(file.read_texts("/none").empty());
  EXPECT_EQ(file.shape("/empty"), (std::vector<std::size_t>{0, 3}));
  EXPECT_TRUE(file.read_doubles("/empty").empty());
  EXPECT_EQ(file.text_attribute("/deep", "name"), "Böschung");
  EXPECT_EQ(file.text_attribute("/deep", "empty"), "");
  EXPECT_EQ(file.double_attribute("/deep", "value"), 0.1);
  EXPECT_TRUE(file.exists("/deep/down"));
  EXPECT_FALSE(file.exists("/deep/up/texts"));
  EXPECT_THROW(static_cast<void>(file.double_attribute("/deep", "name")), FileError);
  EXPECT_THROW(static_cast<void>(file.read_integers("/empty")), FileError);
}

TEST(Hdf5File, ATextWithNulIsNotCutOff) {
  const TemporaryFolder folder;
  Hdf5File file(folder.file("a.h5"), Hdf5File::Mode::create);
  EXPECT_THROW(file.write_text("/text", std::string("a\0b", 3)), FileError);
}

}  // namespace case_file_test
}  // namespace suffuse
