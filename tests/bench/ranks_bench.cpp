/// Linear systems of the flow that ranks share, and the bandwidth of the machine in the same run:
/// `make -C workflows ranks`. A line per system, on standard output, of rank 0.

#include <chrono>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include "bench/bench.hpp"
#include "box_mesh.hpp"
#include "linear/shared_system.hpp"
#include "mixed/mixed_matrix.hpp"
#include "ranks/mpi_ranks.hpp"
#include "ranks/ordered_mesh.hpp"
#include "solver/model_case.hpp"

namespace suffuse::bench {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A number in [0, 1) that belongs to a row of the whole mesh, the same on any ranks (splitmix64).
double random_of(long row) {
  auto x = static_cast<std::uint64_t>(row + 1) * 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return static_cast<double>((x ^ (x >> 31U)) >> 11U) * 0x1p-53;
}

/// Bandwidth of a triad that all ranks do at the same time, GB/s.
double triad_of_all(const Ranks& ranks) {
  constexpr std::size_t size = 8 << 20;
  std::vector<double> a(size, 1.0);
  const std::vector<double> b(size, 2.0);
  const std::vector<double> c(size, 3.0);
  double best = 1e300;
  for (int run = 0; run < 10; ++run) {
    largest_of_all(ranks, 0.0);
    const auto start = std::chrono::steady_clock::now();
    triad(a, b, c, 1);
    best = std::min(best, largest_of_all(ranks, seconds_since(start)));
  }
  return 24e-9 * static_cast<double>(size) * ranks.count() / best;
}

Mesh<2> mesh_with(double faces, std::integral_constant<int, 2> /*dimension*/) {
  const int n = static_cast<int>(std::lround(std::sqrt(faces / 3.0)));
  return in_order(model::column_mesh(n, n, 1.0, 1.0, model::jittered(0.2 / n, 2)));
}
Mesh<3> mesh_with(double faces, std::integral_constant<int, 3> /*dimension*/) {
  const int n = static_cast<int>(std::lround(std::cbrt(faces / 12.0)));
  return in_order(model::box_mesh({n, n, n}));
}

/// Solves a system for random pressures, whose conductivities are scattered between 1 and
/// 1/contrast, to 1e-14 of each row's diagonal; then another with the same matrix.
template <int Dim>
void measure(const std::shared_ptr<const Ranks>& ranks, double faces, double contrast) {
  const Mesh<Dim> whole = mesh_with(faces, std::integral_constant<int, Dim>());
  const LocalMesh<Dim> local = local_mesh(whole, ranks->rank(), ranks->count());
  const Grid<Dim> grid(local.mesh, {ranks, local.numbers});
  std::vector<FaceKind> kinds(grid.face_count(), FaceKind::interior);
  for (int f = 0; f < grid.face_count(); ++f) {
    const double height = grid.face_centre(f)[Dim - 1];
    if (height < 1e-9 || height > 1.0 - 1e-9) kinds[f] = FaceKind::pressure;
  }
  MomentumLaw<Dim> law;
  for (const long e : local.numbers.element) {
    law.mobility.push_back(std::pow(contrast, -random_of(e)));
  }
  MixedMatrix<Dim> matrix(grid, kinds, 1);
  matrix.assemble(law, std::vector<double>(law.mobility.size(), 0.0));
  Eigen::VectorXd pressure(matrix.unknowns());
  for (int f = 0; f < grid.face_count(); ++f) {
    if (matrix.unknown(f) >= 0) {
      pressure[matrix.unknown(f)] = random_of(grid.face_numbers()[f]);
    }
  }
  const Eigen::VectorXd guess = Eigen::VectorXd::Zero(pressure.size());
  const Eigen::VectorXd tolerance = 1e-14 * matrix.values().diagonal();
  const Eigen::VectorXd rhs = matrix.values() * pressure;
  const Eigen::VectorXd twice = 2.0 * rhs;

  SharedSystem system(*ranks, grid.face_rows(), matrix.unknowns_of_faces());
  largest_of_all(*ranks, 0.0);
  auto start = std::chrono::steady_clock::now();
  const Eigen::VectorXd found = system.solve({matrix.values(), rhs, guess, tolerance});
  const double first = largest_of_all(*ranks, seconds_since(start));
  const auto iterations = static_cast<double>(system.counts().iterations);
  start = std::chrono::steady_clock::now();
  system.solve({matrix.values(), twice, guess, tolerance});
  const double again = largest_of_all(*ranks, seconds_since(start));
  const double iteration = again / (static_cast<double>(system.counts().iterations) - iterations);
  const NumberRange own = system.own();
  const int count = *own.end() - *own.begin();
  const double error = largest_of_all(
      *ranks,
      count == 0 ? 0.0 : (found - pressure).segment(*own.begin(), count).lpNorm<Eigen::Infinity>());
  const double rows = sum_of_all(*ranks, count);
  if (ranks->rank() > 0) return;
  std::cout << ranks->count() << ',' << Dim << ',' << rows << ',' << contrast << ',' << iterations
            << ',' << first - iterations * iteration << ',' << iteration << ',' << error
            << std::endl;
}

}  // namespace
}  // namespace suffuse::bench

int main(int argc, char** argv) {
  using namespace suffuse;
  const MpiProcess process;
  const std::shared_ptr<const Ranks> ranks = mpi_ranks();
  const double bandwidth = bench::triad_of_all(*ranks);
  if (ranks->rank() == 0) {
    std::cout << std::setprecision(4) << "# triad of " << ranks->count() << " ranks: " << bandwidth
              << " GB/s\nranks,dimension,rows,contrast,iterations,setup_s,iteration_s,error\n";
  }
  std::vector<double> sizes{1e4, 1e5, 5e5, 1e6};
  if (argc > 1) sizes = {std::atof(argv[1])};
  for (const double faces : sizes) {
    for (const double contrast : {1.0, 1e6, 1e12}) {
      bench::measure<2>(ranks, faces, contrast);
      bench::measure<3>(ranks, faces, contrast);
    }
  }
  return 0;
}
