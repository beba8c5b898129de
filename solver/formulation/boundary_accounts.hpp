#pragma once

/// Masses of water and fines, and the volume of liquid in the flow, that crossed each boundary of
/// the scene since the start. Makes the rows of boundaries.csv.

#include <vector>

#include "case/case_file.hpp"
#include "files/tables.hpp"
#include "grid/grid.hpp"
#include "ranks/ranks.hpp"

namespace suffuse {

/// Sums of outflow and inflow.
struct BothWays {
  ExactSum in, out;

  void add(double outward) {
    if (outward > 0.0) out.add(outward);
    if (outward < 0.0) in.add(-outward);
  }
};

template <int Dim>
class BoundaryAccounts {
 public:
  /// An account for each of `booked_boundaries`. Throws as `face_conditions` does.
  BoundaryAccounts(const Case<Dim>& c, const Grid<Dim>& grid);

  /// Books masses that left through an outer face, kg; negative: entered.
  void book(int face, double water, double fines);
  /// Books masses that crossed all faces along their normals, kg.
  void book(const std::vector<double>& water, const std::vector<double>& fines);
  /// Books volumes of liquid along the faces' normals, m3, in one interval of the flow.
  void book_liquid(const std::vector<double>& volumes);

  /// `face_flux`: present flux along the faces' normals, m3/s.
  [[nodiscard]] std::vector<BoundaryRow> rows(double time,
                                              const std::vector<double>& face_flux) const;

  void archive(auto& archive) { archive_sums(archive, grid_.ranks(), each_of(sums_)); }

 private:
  struct Sums {
    BothWays water, fines, liquid;
  };
  /// All sums of the accounts.
  static std::vector<ExactSum*> each_of(std::vector<Sums>& accounts) {
    std::vector<ExactSum*> each;
    for (Sums& sums : accounts) {
      for (BothWays* both : {&sums.water, &sums.fines, &sums.liquid}) {
        each.push_back(&both->in);
        each.push_back(&both->out);
      }
    }
    return each;
  }
  struct AccountFace {
    int face;
    int account;
  };

  const Grid<Dim>& grid_;
  std::vector<std::string> names_;
  std::vector<AccountFace> faces_;  ///< outer faces that have an account, ascending
  std::vector<int> account_;        ///< per face, -1: none
  std::vector<Sums> sums_;
};

}  // namespace suffuse
