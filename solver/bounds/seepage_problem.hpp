#pragma once

/// A flow by mixed elements as a linear problem in heads: which faces hold a head, which have a
/// given flux, and pairs of fields near its solutions.

#include <memory>
#include <optional>
#include <vector>

#include "bounds/seepage_fields.hpp"
#include "bounds/seepage_state.hpp"

namespace suffuse {

/// Differences below this share of the largest head, or of all fluxes, are round-off.
inline constexpr double seepage_round_off = 1e-9;

/// Two fields near one flow: a continuous head with the prescribed values, and fluxes that balance
/// in each element.
template <int Dim>
struct FieldPair {
  std::vector<double> node_head;  ///< m
  std::vector<double> face_flux;  ///< along the faces' normals, m3/s
  Slopes<Dim> of_head;
  Slopes<Dim> of_flux;

  [[nodiscard]] Slopes<Dim> gap() const { return sum(of_head, -1.0, of_flux); }
};

/// What drives the dual of a number.
template <int Dim>
struct DualLoad {
  int group = -1;              ///< boundaries with a unit head; -1: none
  std::vector<double> source;  ///< that leaves each element, m3/s; empty: none
  /// Slope of the head, 1, that drives liquid through each element in addition; empty: none.
  VectorField<Dim> slope;
};

/// What crosses one entry of the scene's boundaries, m3/s.
struct Crossing {
  double held = 0.0;     ///< out minus in, through faces that hold a head
  double given = 0.0;    ///< out minus in, through the others
  double out = 0.0;      ///< through faces by which liquid leaves
  double in = 0.0;       ///< through faces by which it enters
  double in_time = 0.0;  ///< error of out minus in, by the last step in time
};

template <int Dim>
class SeepageProblem {
 public:
  explicit SeepageProblem(const SeepageState<Dim>& state);

  [[nodiscard]] const SeepageState<Dim>& state() const { return state_; }
  [[nodiscard]] const SeepageEnergy<Dim>& energy() const { return energy_; }
  /// Errors of heads at faces by the last step in time, m; empty where they are not known.
  [[nodiscard]] std::vector<double> head_errors() const;
  /// Per entry of the scene's boundaries.
  [[nodiscard]] const std::vector<Crossing>& crossings() const { return crossings_; }
  /// Largest conductivity times the largest head and the size of the model, m3/s.
  [[nodiscard]] double largest_flux() const;
  /// Sum over the outer faces, m3/s.
  [[nodiscard]] double all_fluxes() const { return all_fluxes_; }
  /// Boundaries that hold heads: those that share a node are one group, as a unit head at one of
  /// them alone would jump there.
  [[nodiscard]] const std::vector<std::vector<int>>& groups() const { return groups_; }

  /// The fields of the flow itself.
  [[nodiscard]] const FieldPair<Dim>& flow() const { return flow_; }
  /// The gap between the two fields of the flow, and its norm.
  [[nodiscard]] const Slopes<Dim>& gap() const { return gap_; }
  [[nodiscard]] double gap_norm() const { return gap_norm_; }
  /// The fields of the flow that a load drives, without head and flux at the boundaries otherwise.
  /// Throws NumericalError.
  [[nodiscard]] FieldPair<Dim> dual(const DualLoad<Dim>& load);
  /// The fields of one head everywhere, m.
  [[nodiscard]] FieldPair<Dim> uniform(double head) const;
  /// The heads of both groups if there are two, each with one head, and no other flux.
  [[nodiscard]] std::optional<std::array<double, 2>> two_heads() const;
  /// a + factor b.
  [[nodiscard]] FieldPair<Dim> combined(FieldPair<Dim> a, double factor,
                                        const FieldPair<Dim>& b) const;

  /// Integrals of a dual, m4/s: its head times the outward flux that is given, at boundaries and as
  /// stored water; and its outward flux times the flow's head at boundaries that hold heads.
  struct Products {
    double given = 0.0;
    double held = 0.0;
  };
  [[nodiscard]] Products products(const FieldPair<Dim>& dual) const;

  /// Why the fields bound nothing; empty where they do.
  [[nodiscard]] std::string objection() const;
  /// Whether no element stores water or gives it off.
  [[nodiscard]] bool balances() const { return balances_; }
  /// Whether heads differ where two boundaries meet.
  [[nodiscard]] bool jumps() const;

 private:
  [[nodiscard]] std::vector<double> conductivities() const;
  /// What flows out of each element minus what flows in, m3/s.
  [[nodiscard]] std::vector<double> outflows() const;
  /// Whether the fluxes are those that the heads drive through the conductivities of now.
  [[nodiscard]] bool follows_conductivity() const;
  /// Heads at the centres of faces, m.
  [[nodiscard]] std::vector<double> heads(const std::vector<double>& face_pressure) const;
  [[nodiscard]] double relative_conductivity(std::size_t element) const;
  [[nodiscard]] bool holds_head(int face) const;
  [[nodiscard]] double height_of(const Vector<Dim>& x) const;
  void prescribe();
  void join_groups(const std::vector<std::vector<int>>& boundaries_of_node);
  void sum_crossings();
  [[nodiscard]] FieldPair<Dim> pair(const std::vector<double>& face_pressure,
                                    const std::vector<double>& face_flux,
                                    const VectorField<Dim>& slope,
                                    const std::vector<std::optional<double>>& prescribed) const;
  ImplicitMixed<Dim>& dual_solver();

  SeepageState<Dim> state_;
  const Grid<Dim>& grid_;
  double weight_;  ///< pressure per head, Pa/m
  SeepageEnergy<Dim> energy_;
  std::vector<std::optional<double>> prescribed_;  ///< per node, m
  std::vector<double> inflow_;                     ///< per face, m3/s; 0 where a head is held
  std::vector<int> group_of_face_;                 ///< -1 where no head is held
  std::vector<std::vector<int>> groups_;
  std::vector<char> holds_in_part_;  ///< per boundary: some of its faces hold a head, others do not
  double largest_head_ = 0.0;
  double largest_jump_ = 0.0;  ///< between the heads of two faces at one node, m
  std::vector<Crossing> crossings_;
  double all_fluxes_ = 0.0;
  std::vector<double> outflow_;  ///< of each element: water that it gives off, m3/s
  bool balances_ = false;
  FieldPair<Dim> flow_;
  Slopes<Dim> gap_;
  double gap_norm_ = 0.0;
  std::unique_ptr<ImplicitMixed<Dim>> dual_solver_;
};

}  // namespace suffuse
