#include "case/case_file.hpp"
#include "edited_files.hpp"
#include "refusal.hpp"
#include "targets.hpp"

namespace suffuse::fuzz {
namespace {

/// What the reader takes, the writer can write again, and it stays what it was.
void check_round_trip(const Case<2>& c, const std::string& path) {
  const std::string again = path + ".again.h5";
  write_case(again, c);
  const Case<2> read = read_case<2>(again);
  require(read.mesh.nodes == c.mesh.nodes && read.mesh.elements == c.mesh.elements &&
              read.mesh.element_region == c.mesh.element_region &&
              read.mesh.region_names == c.mesh.region_names &&
              read.mesh.boundaries.size() == c.mesh.boundaries.size(),
          "a mesh changes when it is written and read");
  require(read.solid_points.barycentric == c.solid_points.barycentric &&
              read.liquid_points.barycentric == c.liquid_points.barycentric,
          "points change when they are written and read");
}

}  // namespace

void try_case(const std::string& input) {
  const std::string path = lay_out_case(input);
  static_cast<void>(is_taken(path, [&] {
    static_cast<void>(read_case_dimension(path));
    const Case<2> c = read_case<2>(path);
    check_round_trip(c, path);
  }));
  static_cast<void>(is_taken(path, [&] { static_cast<void>(read_case<3>(path)); }));
  forget_files();
}

}  // namespace suffuse::fuzz
