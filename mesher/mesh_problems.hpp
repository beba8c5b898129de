#pragma once

/// Common words and lists of problems of a mesh.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "common/errors.hpp"
#include "mesh/mesh.hpp"
#include "mesh/place_text.hpp"

namespace suffuse {

/// Names of elements, of their sides, and of the physical groups that hold them.
template <int Dim>
struct MeshWords {
  static constexpr const char* elements = Dim == 2 ? "triangles" : "tetrahedra";
  static constexpr const char* element = Dim == 2 ? "triangle" : "tetrahedron";
  static constexpr const char* side = Dim == 2 ? "edge" : "face";
  static constexpr const char* sides = Dim == 2 ? "edges" : "faces";
  static constexpr const char* region = Dim == 2 ? "surface" : "volume";
  static constexpr const char* boundary = Dim == 2 ? "curve" : "surface";
};

/// Problems of one kind: the first few one by one, the rest counted.
class ProblemKind {
 public:
  ProblemKind(std::vector<InputProblem>& problems, std::string expected)
      : problems_(problems), expected_(std::move(expected)) {}
  ProblemKind(const ProblemKind&) = delete;
  ProblemKind& operator=(const ProblemKind&) = delete;
  ~ProblemKind() {
    if (count_ <= max_examples) return;
    problems_[last_].found += ", and " + std::to_string(count_ - max_examples) + " more like it";
  }
  void add(const std::string& found) {
    if (++count_ > max_examples) return;
    last_ = problems_.size();
    problems_.push_back({"", "", found, expected_, ""});
  }

 private:
  static constexpr std::size_t max_examples = 5;

  std::vector<InputProblem>& problems_;
  std::string expected_;
  std::size_t count_ = 0;
  std::size_t last_ = 0;  // index of the last one listed
};

}  // namespace suffuse
