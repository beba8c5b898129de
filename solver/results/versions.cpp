#include "results/versions.hpp"

#include <hdf5.h>

#include <Eigen/Core>

#include "results/git_description.hpp"  // generated at build time

namespace suffuse {
namespace {

#if defined(__clang__)
constexpr const char* compiler = __VERSION__;
#else
constexpr const char* compiler = "g++ " __VERSION__;
#endif

std::string dotted(unsigned a, unsigned b, unsigned c) {
  return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c);
}

}  // namespace

std::map<std::string, std::string> versions() {
  unsigned major = 0;
  unsigned minor = 0;
  unsigned release = 0;
  H5get_libversion(&major, &minor, &release);
  return {
      {"suffuse", SUFFUSE_VERSION},
      {"git", git_description},
      {"compiler", compiler},
      {"eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"hdf5", dotted(major, minor, release)},
  };
}

}  // namespace suffuse
