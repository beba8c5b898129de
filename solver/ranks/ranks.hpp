#pragma once

/// The ranks that share a run: processes that hold a part of the mesh each, and send each other
/// what they do not have. A program of one process is alone: nothing is sent, and every call gives
/// back what it got. All ranks have to make the same calls in the same order.

#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ranks/exact_sum.hpp"
#include "ranks/own_rows.hpp"
#include "ranks/shared_factor.hpp"

namespace suffuse {

class Ranks {
 public:
  Ranks() = default;
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] virtual int rank() const { return 0; }
  [[nodiscard]] virtual int count() const { return 1; }
  /// Replaces each sum of this rank by the sum over all ranks.
  virtual void sum(const std::vector<ExactSum*>& /*sums*/) const {}
  /// Replaces each value by the largest of all ranks.
  virtual void largest(std::span<double> /*values*/) const {}
  /// Sum of the counts of lower ranks.
  [[nodiscard]] virtual long before(long /*count*/) const { return 0; }
  /// The bytes of rank 0.
  [[nodiscard]] virtual std::vector<std::uint8_t> of_first(std::vector<std::uint8_t> own) const {
    return own;
  }
  /// The text of the lowest rank that has one; empty if none has.
  [[nodiscard]] virtual std::string first_text(std::string own) const { return own; }
  /// The bytes of all ranks, in their order, on rank 0; nothing on the others.
  [[nodiscard]] virtual std::vector<std::uint8_t> gather(std::vector<std::uint8_t> own) const {
    return own;
  }
  /// Sends bytes to each rank. Returns what the others sent, in the order of ranks.
  [[nodiscard]] virtual std::vector<std::uint8_t> send(
      const std::vector<std::vector<std::uint8_t>>& /*to*/) const {
    return {};
  }
  /// Whether all other ranks call this too, within some seconds. A rank that fails alone gets
  /// false.
  [[nodiscard]] virtual bool all_come() const { return true; }
  /// Ends the processes of all ranks with this exit code.
  virtual void end_all(int /*code*/) const {}
  /// What solves symmetric systems that several ranks share; null: this program is alone.
  [[nodiscard]] virtual std::unique_ptr<SharedFactor> symmetric_factor() const { return nullptr; }
  /// Rows of which this rank holds those with the numbers `global` in the whole mesh,
  /// and owns those from `first` to `last`.
  [[nodiscard]] virtual OwnRows rows(const std::vector<long>& /*global*/, int first,
                                     int last) const {
    return {first, last, nullptr};
  }
};

/// The largest value of all ranks.
inline double largest_of_all(const Ranks& ranks, double value) {
  ranks.largest(std::span(&value, 1));
  return value;
}

/// The smallest value of all ranks.
inline double smallest_of_all(const Ranks& ranks, double value) {
  return -largest_of_all(ranks, -value);
}

/// Whether any rank has it.
inline bool any_of_all(const Ranks& ranks, bool has) {
  return largest_of_all(ranks, has ? 1.0 : 0.0) > 0.0;
}

/// The sum over all ranks; alone the value itself.
inline double sum_of_all(const Ranks& ranks, double own) {
  ExactSum sum;
  sum.add(own);
  ranks.sum({&sum});
  return sum.value();
}

/// Whether this is the lowest rank of those for which `has` is true.
inline bool is_first(const Ranks& ranks, bool has) {
  const std::string own = std::to_string(ranks.rank());
  return ranks.first_text(has ? own : "") == own;
}

/// The bytes of values, as ranks send them.
template <class Value>
std::vector<std::uint8_t> bytes_of(const std::vector<Value>& values) {
  static_assert(std::is_trivially_copyable_v<Value>);
  const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
  return {begin, begin + values.size() * sizeof(Value)};
}
template <class Value>
std::vector<Value> values_of(const std::vector<std::uint8_t>& bytes) {
  std::vector<Value> values(bytes.size() / sizeof(Value));
  if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// The values of all ranks, in their order, on rank 0; none on the others.
template <class Value>
std::vector<Value> gather_values(const Ranks& ranks, const std::vector<Value>& own) {
  return values_of<Value>(ranks.gather(bytes_of(own)));
}

/// Sends values to each rank. Returns what the others sent, in the order of ranks.
template <class Value>
std::vector<Value> send_values(const Ranks& ranks, const std::vector<std::vector<Value>>& to) {
  std::vector<std::vector<std::uint8_t>> bytes;
  bytes.reserve(to.size());
  for (const std::vector<Value>& values : to) bytes.push_back(bytes_of(values));
  return values_of<Value>(ranks.send(bytes));
}

/// The values of all ranks, in their order, on all of them.
template <class Value>
std::vector<Value> values_on_all(const Ranks& ranks, const std::vector<Value>& own) {
  return values_of<Value>(ranks.of_first(ranks.gather(bytes_of(own))));
}

/// Throws on all ranks the error of the lowest rank that has one; `own` is null on those that have
/// none.
void throw_together(const Ranks& ranks, const std::exception_ptr& own);

/// Does work that may throw on some ranks alone, and then throws on all of them: a rank that left
/// alone would have the others wait for ever.
template <class Work>
void together(const Ranks& ranks, const Work& work) {
  if (ranks.count() == 1) {
    work();
    return;
  }
  std::exception_ptr error;
  try {
    work();
  } catch (...) {
    error = std::current_exception();
  }
  throw_together(ranks, error);
}

/// Collects in an archive the sums over all ranks, of those of this one, or restores them: rank 0
/// gets them then, the others zero.
inline void archive_sums(auto& archive, const Ranks& ranks, const std::vector<ExactSum*>& sums) {
  std::vector<ExactSum> all;
  all.reserve(sums.size());
  std::vector<ExactSum*> each;
  each.reserve(sums.size());
  for (const ExactSum* sum : sums) each.push_back(&all.emplace_back(*sum));
  if (!archive.restores()) ranks.sum(each);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    archive(all[i]);
    *sums[i] = !archive.restores() ? *sums[i] : ranks.rank() == 0 ? all[i] : ExactSum();
  }
}

/// The sums over all ranks, of those of this one.
inline std::vector<double> values_of_all(const Ranks& ranks, std::vector<ExactSum> sums) {
  std::vector<ExactSum*> all;
  all.reserve(sums.size());
  for (ExactSum& sum : sums) all.push_back(&sum);
  ranks.sum(all);
  std::vector<double> result;
  result.reserve(sums.size());
  for (const ExactSum& sum : sums) result.push_back(sum.value());
  return result;
}

}  // namespace suffuse
