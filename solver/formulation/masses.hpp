#pragma once

/// Masses of water and fines: storage and crossings of borders, for the whole model (account 0),
/// for each region r (account r + 1), and for each boundary of the scene. Makes the rows of the
/// ledger.

#include <array>
#include <vector>

#include "files/tables.hpp"
#include "formulation/boundary_accounts.hpp"
#include "grid/grid.hpp"
#include "points/point_transport.hpp"
#include "ranks/ranks.hpp"

namespace suffuse {

/// Masses that crossed a boundary since the start, kg.
struct Crossed {
  double water_in = 0.0;
  double fines_in = 0.0;
  double water_out = 0.0;
  double fines_out = 0.0;
  double points_in = 0.0;  ///< liquid points, numbers
  double points_out = 0.0;
  double water_net = 0.0;  ///< out minus in, more accurate than the difference of both
  double fines_net = 0.0;
};

/// Masses inside a boundary, kg.
struct Stored {
  static constexpr bool has_no_gaps = true;  ///< see StateArchive
  double solid = 0.0;
  double erodible = 0.0;
  double water = 0.0;
  double fines = 0.0;
  double eroded = 0.0;     ///< since the start
  double deposited = 0.0;  ///< since the start
  double pending = 0.0;    ///< eroded, but not yet in liquid points
  double carried = 0.0;    ///< net solid that moving points carried in since the start
  double points = 0.0;     ///< liquid points, number
};

/// Running sums behind one `Stored`.
struct StoredSums {
  ExactSum solid, erodible, water, fines, eroded, deposited, pending, carried, points;

  [[nodiscard]] Stored totals() const {
    return {solid.value(),     erodible.value(), water.value(),   fines.value(), eroded.value(),
            deposited.value(), pending.value(),  carried.value(), points.value()};
  }
};

/// The masses in all ranks, from the sums of this one. The sums of the model have what no region
/// has, and get those of the regions in addition.
std::vector<Stored> totals(const Ranks& ranks, std::vector<StoredSums> sums);

/// Running sums behind one `Crossed`.
struct CrossedSums {
  ExactSum water_in, fines_in, water_out, fines_out, points_in, points_out;

  /// The masses that crossed in all ranks.
  [[nodiscard]] Crossed totals(const Ranks& ranks) const;
  [[nodiscard]] std::array<ExactSum*, 6> all() {
    return {&water_in, &fines_in, &water_out, &fines_out, &points_in, &points_out};
  }
};

template <int Dim>
class MassAccounts {
 public:
  /// Throws as `face_conditions` does.
  MassAccounts(const Case<Dim>& c, const Grid<Dim>& grid);

  [[nodiscard]] std::size_t count() const { return faces_.size(); }
  /// Sets the initial storage, per account.
  void open(std::vector<Stored> initial) { initial_ = std::move(initial); }
  /// Storage at the start. Account 0 is that of the whole model, account r + 1 that of region r.
  [[nodiscard]] const Stored& initial(std::size_t account) const { return initial_[account]; }

  /// Books masses that crossed each face along its normal, kg.
  void book(const std::vector<double>& water, const std::vector<double>& fines);
  /// Books points and fines that changed their region.
  void book(const RegionCrossings& crossings);
  /// Books volumes of liquid in the flow across each face along its normal, m3. Points follow the
  /// flow with a delay.
  void book_liquid(const std::vector<double>& volumes) { boundaries_.book_liquid(volumes); }

  /// `stored` per account.
  [[nodiscard]] LedgerRow ledger(double time, const std::vector<Stored>& stored) const;
  [[nodiscard]] std::vector<RegionRow> region_rows(double time, const std::vector<Stored>& stored,
                                                   const SoilMap<Dim>& soils,
                                                   double grain_density) const;
  [[nodiscard]] const BoundaryAccounts<Dim>& boundaries() const { return boundaries_; }

  /// Includes the initial storage: a resumed run does not read the run that it started from.
  void archive(auto& archive) {
    std::vector<ExactSum*> sums;
    for (CrossedSums& crossed : crossed_) {
      for (ExactSum* sum : crossed.all()) sums.push_back(sum);
    }
    archive_sums(archive, grid_.ranks(), sums);
    archive(boundaries_, initial_);
  }

 private:
  struct OutwardFace {
    int face;
    double sign;  ///< +1 if the face's normal points out of the account
  };
  void book(const PointCrossing& point);

  const Grid<Dim>& grid_;
  std::vector<std::vector<OutwardFace>> faces_;  ///< that bound each account
  std::vector<CrossedSums> crossed_;             ///< per account
  BoundaryAccounts<Dim> boundaries_;
  std::vector<Stored> initial_;
};

}  // namespace suffuse
