#include "case/mesh_sizes.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "case/case_file.hpp"
#include "common/errors.hpp"
#include "common/hdf5_io.hpp"
#include "temporary_folder.hpp"

namespace suffuse {
namespace mesh_sizes_test {

using test::read_file;
using test::TemporaryFolder;

/// The unit square in two triangles, of two regions.
MeshSizes<2> square() {
  MeshSizes<2> sizes;
  sizes.mesh.nodes = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  sizes.mesh.elements = {{0, 1, 2}, {0, 2, 3}};
  sizes.mesh.element_region = {0, 1};
  sizes.mesh.region_names = {"sand", "clay"};
  sizes.mesh.boundaries = {{"top", {{2, 3}}}};
  sizes.size = {0.1, 0.2, 1.0 / 3.0, 1e-3};
  return sizes;
}

template <int Dim>
std::string reading_failure(const std::string& path) {
  try {
    static_cast<void>(read_mesh_sizes<Dim>(path));
  } catch (const FileError& error) {
    return error.what();
  }
  return "no FileError";
}

TEST(MeshSizes, ReadsBackExactlyWhatWasWritten) {
  const TemporaryFolder folder;
  const MeshSizes<2> written = square();
  const std::string path = folder.file("a.h5");
  write_mesh_sizes(path, written.mesh, written.size);
  EXPECT_EQ(folder.count(), 1);
  EXPECT_EQ(read_mesh_sizes_dimension(path), 2);
  const MeshSizes<2> read = read_mesh_sizes<2>(path);
  EXPECT_EQ(read.mesh.nodes, written.mesh.nodes);
  EXPECT_EQ(read.mesh.elements, written.mesh.elements);
  EXPECT_EQ(read.mesh.element_region, written.mesh.element_region);
  EXPECT_EQ(read.mesh.region_names, written.mesh.region_names);
  EXPECT_TRUE(read.mesh.boundaries.empty());
  EXPECT_EQ(read.size, written.size);
}

TEST(MeshSizes, ReadsBackTetrahedra) {
  const TemporaryFolder folder;
  MeshSizes<3> written;
  written.mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  written.mesh.elements = {{0, 1, 2, 3}};
  written.mesh.element_region = {0};
  written.mesh.region_names = {"sand"};
  written.size = {0.1, 0.2, 0.3, 0.4};
  const std::string path = folder.file("a.h5");
  write_mesh_sizes(path, written.mesh, written.size);
  EXPECT_EQ(read_mesh_sizes_dimension(path), 3);
  const MeshSizes<3> read = read_mesh_sizes<3>(path);
  EXPECT_EQ(read.mesh.nodes, written.mesh.nodes);
  EXPECT_EQ(read.mesh.elements, written.mesh.elements);
  EXPECT_EQ(read.size, written.size);
  EXPECT_EQ(reading_failure<2>(path), path + ": has sizes of dimension 3; expected 2");
}

TEST(MeshSizes, RefusesOtherFiles) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  EXPECT_EQ(reading_failure<2>(path), path + ": there is no such file");
  folder.write("a.h5", "not HDF5 at all");
  EXPECT_EQ(reading_failure<2>(path),
            path + ": is not an HDF5 file; expected one that Suffuse wrote");
  Hdf5File(path, Hdf5File::Mode::create).write_text("/text", "hello");
  EXPECT_EQ(reading_failure<2>(path),
            path + ": is not a file of sizes; expected what suffuse-solver --sizes writes");
  Case<2> of_case;
  of_case.mesh = square().mesh;
  write_case(path, of_case);
  EXPECT_EQ(reading_failure<2>(path),
            path + ": is not a file of sizes; expected what suffuse-solver --sizes writes");
}

TEST(MeshSizes, RefusesSizesThatAreNone) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  MeshSizes<2> sizes = square();
  for (const double size : {0.0, -0.1, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    sizes.size[2] = size;
    write_mesh_sizes(path, sizes.mesh, sizes.size);
    EXPECT_EQ(reading_failure<2>(path),
              path +
                  ": /size: the size at node 2 is not positive and finite; write it anew with "
                  "suffuse-solver --sizes");
  }
}

TEST(MeshSizes, RefusesAMeshThatIsNone) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  MeshSizes<2> sizes = square();
  sizes.mesh.elements[1] = {0, 3, 2};
  write_mesh_sizes(path, sizes.mesh, sizes.size);
  EXPECT_EQ(reading_failure<2>(path),
            path +
                ": /mesh/elements: element 1 has no positive volume; write it anew with "
                "suffuse-solver --sizes");
}

TEST(MeshSizes, RefusesDamage) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  write_mesh_sizes(path, square().mesh, square().size);
  const std::string whole = read_file(path);
  for (std::size_t length = 0; length < whole.size(); length += 499) {
    const std::string cut = folder.write("cut.h5", whole.substr(0, length));
    EXPECT_NE(reading_failure<2>(cut), "no FileError") << length << " bytes";
  }
  for (std::size_t at = 0; at < whole.size(); at += 31) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(~damaged[at]);
    const std::string file = folder.write("damaged.h5", damaged);
    const std::string failure = reading_failure<2>(file);  // some bytes are slack
    EXPECT_TRUE(failure == "no FileError" || failure.find(file) != std::string::npos) << failure;
  }
}

}  // namespace mesh_sizes_test
}  // namespace suffuse
