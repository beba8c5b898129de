#pragma once

/// The masses of water and fines: what is stored and what crossed which border, for the whole
/// model (account 0) and for each region r (account r + 1), and what crossed each boundary of the
/// scene. The ledger of the results is made here.

#include <array>
#include <vector>

#include "files/tables.hpp"
#include "formulation/boundary_accounts.hpp"
#include "grid/compensated_sum.hpp"
#include "grid/grid.hpp"
#include "points/point_transport.hpp"

namespace suffuse {

/// Masses that crossed a boundary since the start, kg.
struct Crossed {
  double water_in = 0.0;
  double fines_in = 0.0;
  double water_out = 0.0;
  double fines_out = 0.0;
  double points_in = 0.0;  ///< liquid points, numbers
  double points_out = 0.0;
  double water_net = 0.0;  ///< out minus in, with more digits than their difference
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
  double pending = 0.0;    ///< eroded, but not yet with any liquid
  double carried = 0.0;    ///< solid that points have carried in, minus out, since the start
  double points = 0.0;     ///< liquid points, number
};

/// Running sums behind one `Stored`.
struct StoredSums {
  CompensatedSum solid, erodible, water, fines, eroded, deposited, pending, carried;
  double points = 0.0;

  [[nodiscard]] Stored totals() const {
    return {solid.value(),     erodible.value(), water.value(),   fines.value(), eroded.value(),
            deposited.value(), pending.value(),  carried.value(), points};
  }
};

std::vector<Stored> totals(const std::vector<StoredSums>& sums);

/// Running sums behind one `Crossed`.
struct CrossedSums {
  static constexpr bool has_no_gaps = true;  ///< see StateArchive
  CompensatedSum water_in, fines_in, water_out, fines_out;
  double points_in = 0.0;
  double points_out = 0.0;

  [[nodiscard]] Crossed totals() const {
    return {
        water_in.value(), fines_in.value(), water_out.value(),         fines_out.value(),
        points_in,        points_out,       water_out.minus(water_in), fines_out.minus(fines_in)};
  }
};

template <int Dim>
class MassAccounts {
 public:
  /// Throws as `face_conditions` does.
  MassAccounts(const Case<Dim>& c, const Grid<Dim>& grid);

  [[nodiscard]] std::size_t count() const { return faces_.size(); }
  /// What is stored at the start, per account.
  void open(std::vector<Stored> initial) { initial_ = std::move(initial); }
  /// In the whole model.
  [[nodiscard]] const Stored& initial() const { return initial_[0]; }

  /// Books what crossed each face along its normal, kg.
  void book(const std::vector<double>& water, const std::vector<double>& fines);
  /// Books points that changed their region, and fines that did.
  void book(const RegionCrossings& crossings);
  /// Books volumes of liquid that crossed each face along its normal, m3: of the flow, which points
  /// follow with a delay.
  void book_liquid(const std::vector<double>& volumes) { boundaries_.book_liquid(volumes); }

  /// `stored` per account.
  [[nodiscard]] LedgerRow ledger(double time, const std::vector<Stored>& stored) const;
  [[nodiscard]] std::vector<RegionRow> region_rows(double time, const std::vector<Stored>& stored,
                                                   const SoilMap<Dim>& soils,
                                                   double grain_density) const;
  [[nodiscard]] const BoundaryAccounts<Dim>& boundaries() const { return boundaries_; }

  /// What was stored at the start too: a run that started from another one goes on without it.
  void archive(auto& archive) { archive(crossed_, boundaries_, initial_); }

 private:
  struct OutwardFace {
    int face;
    double sign;  ///< +1 where the face's normal points out of the account
  };
  void book(const PointCrossing& point);

  const Grid<Dim>& grid_;
  std::vector<std::vector<OutwardFace>> faces_;  ///< that bound each account
  std::vector<CrossedSums> crossed_;             ///< per account
  BoundaryAccounts<Dim> boundaries_;
  std::vector<Stored> initial_;
};

}  // namespace suffuse
