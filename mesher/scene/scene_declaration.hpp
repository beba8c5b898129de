#pragma once

/// Declares a key of a scene in one expression: its storage and its allowed values. Only for the
/// lists of keys.

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scene/scene_schema.hpp"

namespace suffuse::declaration {

// Storage of keys.

template <class Member>
auto at(Member Scene::*member) {
  return [=](Scene& scene, std::size_t) -> Member& { return scene.*member; };
}

template <class Group, class Member>
auto at(Group Scene::*group, Member Group::*member) {
  return [=](Scene& scene, std::size_t) -> Member& { return scene.*group.*member; };
}

template <class Group, class Inner, class Member>
auto at(Group Scene::*group, Inner Group::*inner, Member Inner::*member) {
  return [=](Scene& scene, std::size_t) -> Member& { return scene.*group.*inner.*member; };
}

template <class Member>
auto in_soil(Member Soil::*member) {
  return [=](Scene& scene, std::size_t i) -> Member& { return scene.soils[i].*member; };
}

template <class Member>
auto in_erosion(Member ErosionSettings::*member) {
  return [=](Scene& scene, std::size_t i) -> Member& { return scene.soils[i].erosion.*member; };
}

template <class Member>
auto in_deposition(Member DepositionModel::*member) {
  return [=](Scene& scene, std::size_t i) -> Member& { return scene.soils[i].deposition.*member; };
}

template <class Member>
auto in_retention(Member RetentionModel::*member) {
  return [=](Scene& scene, std::size_t i) -> Member& { return scene.soils[i].retention.*member; };
}

template <class Member>
auto in_skeleton(Member SkeletonModel::*member) {
  return [=](Scene& scene, std::size_t i) -> Member& { return scene.soils[i].skeleton.*member; };
}

/// A member of an entry of a list of the scene.
template <class Entry, class Member>
auto in_list(std::vector<Entry> Scene::*list, Member Entry::*member) {
  return [=](Scene& scene, std::size_t i) -> Member& { return (scene.*list)[i].*member; };
}

/// A member of an entry of a list of `[output]`.
template <class Entry, class Member>
auto in_output(std::vector<Entry> OutputSettings::*list, Member Entry::*member) {
  return [=](Scene& scene, std::size_t i) -> Member& { return (scene.output.*list)[i].*member; };
}

/// A member of a boundary condition; the wells follow the boundaries in the list.
template <class Member>
auto on_boundary(Member BoundaryCondition::*member) {
  return in_list(&Scene::boundaries, member);
}

// Storage of values: one overload for each type of member, with the kind of value that it needs.

inline void keep(double& member, const Value& value) {
  member = std::get<double>(value);
}
inline void keep(std::optional<double>& member, const Value& value) {
  member = std::get<double>(value);
}
inline void keep(std::optional<TimeFunction>& member, const Value& value) {
  if (const auto* constant = std::get_if<double>(&value)) {
    member = *constant;
    return;
  }
  std::vector<std::pair<double, double>> knots;
  for (const auto& row : std::get<Rows>(value)) knots.emplace_back(row[0], row[1]);
  member = TimeFunction(std::move(knots));
}
inline void keep(ResidualFraction& member, const Value& value) {
  member.pairs.clear();
  if (const auto* constant = std::get_if<double>(&value)) {
    member.pairs.emplace_back(0.0, *constant);
    return;
  }
  for (const auto& row : std::get<Rows>(value)) member.pairs.emplace_back(row[0], row[1]);
}
inline void keep(int& member, const Value& value) {
  member = static_cast<int>(std::get<std::int64_t>(value));
}
inline void keep(bool& member, const Value& value) {
  member = std::get<bool>(value);
}
inline void keep(std::optional<bool>& member, const Value& value) {
  member = std::get<bool>(value);
}
inline void keep(std::string& member, const Value& value) {
  member = std::get<std::string>(value);
}
inline void keep(std::array<double, 3>& member, const Value& value) {
  member = {};
  std::ranges::copy(std::get<std::vector<double>>(value), member.begin());
}

inline void keep(FinesFunction& member, const Value& value) {
  if (const auto* constant = std::get_if<double>(&value)) {
    member = *constant;
    return;
  }
  std::vector<std::pair<double, double>> pairs;
  for (const auto& row : std::get<Rows>(value)) pairs.emplace_back(row[0], row[1]);
  member = FinesFunction(std::move(pairs));
}
inline void keep(std::optional<VectorFunction>& member, const Value& value) {
  VectorFunction result;
  const auto add = [&](double time, std::span<const double> components) {
    result.given = components.size();
    std::ranges::copy(components,
                      result.knots.emplace_back(time, VectorFunction::Components{}).second.begin());
  };
  if (const auto* constant = std::get_if<std::vector<double>>(&value)) {
    add(0.0, *constant);
  } else {
    for (const auto& row : std::get<Rows>(value)) add(row[0], std::span(row).subspan(1));
  }
  member = std::move(result);
}

inline void keep(Gradation& member, const Value& value) {
  std::vector<GradationPoint> points;
  for (const auto& row : std::get<Rows>(value)) points.push_back({row[0], row[1]});
  member = Gradation(std::move(points));
}

inline ValueKind kind_of(const double&) {
  return ValueKind::number;
}
inline ValueKind kind_of(const std::optional<double>&) {
  return ValueKind::number;
}
inline ValueKind kind_of(const std::optional<TimeFunction>&) {
  return ValueKind::function;
}
inline ValueKind kind_of(const ResidualFraction&) {
  return ValueKind::function;
}
inline ValueKind kind_of(const FinesFunction&) {
  return ValueKind::function;
}
inline ValueKind kind_of(const std::optional<VectorFunction>&) {
  return ValueKind::vector_function;
}
inline ValueKind kind_of(const int&) {
  return ValueKind::integer;
}
inline ValueKind kind_of(const bool&) {
  return ValueKind::boolean;
}
inline ValueKind kind_of(const std::optional<bool>&) {
  return ValueKind::boolean;
}
inline ValueKind kind_of(const std::string&) {
  return ValueKind::text;
}
inline ValueKind kind_of(const std::array<double, 3>&) {
  return ValueKind::vector;
}
inline ValueKind kind_of(const Gradation&) {
  return ValueKind::gradation;
}

template <class Access>
using MemberOf = std::remove_reference_t<std::invoke_result_t<Access, Scene&, std::size_t>>;

/// A key under construction; each call returns the key so that a declaration is one expression.
struct Declaration : SceneKey {
  Declaration&& named(std::string name) && { return set(symbol, std::move(name)); }
  Declaration&& in(std::string si_unit) && { return set(unit, std::move(si_unit)); }
  Declaration&& above(double x) && { return set(lower, Bound{x, true}); }
  Declaration&& at_least(double x) && { return set(lower, Bound{x, false}); }
  Declaration&& below(double x) && { return set(upper, Bound{x, true}); }
  Declaration&& at_most(double x) && { return set(upper, Bound{x, false}); }
  Declaration&& or_infinite() && { return set(infinite_allowed, true); }
  Declaration&& one_of(std::vector<std::int64_t> all) && { return set(integers, std::move(all)); }
  Declaration&& mandatory() && { return set(required, true); }
  /// Makes the key required if the table lacks the other key.
  Declaration&& mandatory_without(const std::string& other) && {
    unless = other;
    return set(required, true);
  }
  /// Sets the argument of a table of values: `of_argument("|q|", "fluxes (m/s, ascending)")`.
  Declaration&& of_argument(std::string letter, std::string in_words) && {
    argument = std::move(letter);
    return set(arguments, std::move(in_words));
  }
  /// Declares a table of values against the share of fines left.
  Declaration&& of_fines() && {
    argument_is_share = true;
    return std::move(*this).of_argument("share",
                                        "shares of the erodible fines that are left (0 to "
                                        "1, ascending or descending)");
  }
  Declaration&& otherwise(Value value) && { return set(default_value, std::move(value)); }
  Declaration&& otherwise_as(std::string note) && { return set(default_note, std::move(note)); }

 private:
  template <class Field, class New>
  Declaration&& set(Field& field, New&& value) {
    field = std::forward<New>(value);
    return std::move(*this);
  }
};

template <class Access>
Declaration key(const std::string& pattern, Access access, std::string sentence) {
  Declaration d;
  d.pattern = pattern;
  d.kind = kind_of(MemberOf<Access>{});
  d.sentence = std::move(sentence);
  d.store = [access](Scene& scene, std::size_t i, const Value& value) {
    keep(access(scene, i), value);
  };
  return d;
}

/// A key whose value is one of a few words, each standing for a value of the member.
template <class Access>
Declaration choice(const char* pattern, Access access,
                   const std::vector<std::pair<std::string, MemberOf<Access>>>& meanings,
                   std::string sentence) {
  Declaration d;
  d.pattern = pattern;
  d.kind = ValueKind::word;
  d.sentence = std::move(sentence);
  for (const auto& meaning : meanings) d.words.push_back(meaning.first);
  d.store = [access, meanings](Scene& scene, std::size_t i, const Value& value) {
    const auto& word = std::get<std::string>(value);
    access(scene, i) =
        std::ranges::find(meanings, word, [](const auto& m) { return m.first; })->second;
  };
  return d;
}

}  // namespace suffuse::declaration
