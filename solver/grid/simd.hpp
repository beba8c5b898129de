#pragma once

/// A few numbers side by side, which the processor adds and multiplies at once. Compilers know the
/// operators + - * / < and ?: of them for any processor; where its registers are shorter, they take
/// several. Handed on by reference: how such a value is returned depends on the processor.

#include <array>
#include <cmath>
#include <cstring>

namespace suffuse {

constexpr int simd_width = 4;
using SimdDouble4 = double __attribute__((vector_size(simd_width * sizeof(double))));
using SimdDouble2 = double __attribute__((vector_size(2 * sizeof(double))));

/// The numbers from `first` on; nothing is asked of its alignment.
inline void load(const double* first, SimdDouble4& values) {
  std::memcpy(&values, first, sizeof(values));
}

inline void store(const SimdDouble4& values, double* first) {
  std::memcpy(first, &values, sizeof(values));
}

/// Numbers from here and there: lane l is `from[at[l]]`.
inline void gather(const double* from, const std::array<int, simd_width>& at, SimdDouble4& values) {
  values = SimdDouble4{from[at[0]], from[at[1]], from[at[2]], from[at[3]]};
}

/// Two numbers in a row from four places, apart: lane l of `first` and of `second` come from
/// `place(l)`.
template <class Place>
void load_pairs(const Place& place, SimdDouble4& first, SimdDouble4& second) {
  std::array<SimdDouble2, simd_width> pair;
  for (int l = 0; l < simd_width; ++l) std::memcpy(&pair[l], place(l), sizeof(SimdDouble2));
  const SimdDouble4 even = __builtin_shufflevector(pair[0], pair[2], 0, 1, 2, 3);
  const SimdDouble4 odd = __builtin_shufflevector(pair[1], pair[3], 0, 1, 2, 3);
  first = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
  second = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
}

/// The reverse.
template <class Place>
void store_pairs(const SimdDouble4& first, const SimdDouble4& second, const Place& place) {
  const SimdDouble4 even = __builtin_shufflevector(first, second, 0, 4, 2, 6);
  const SimdDouble4 odd = __builtin_shufflevector(first, second, 1, 5, 3, 7);
  const std::array<SimdDouble2, simd_width> pair{
      __builtin_shufflevector(even, even, 0, 1), __builtin_shufflevector(odd, odd, 0, 1),
      __builtin_shufflevector(even, even, 2, 3), __builtin_shufflevector(odd, odd, 2, 3)};
  for (int l = 0; l < simd_width; ++l) std::memcpy(place(l), &pair[l], sizeof(SimdDouble2));
}

/// Asks memory for something that will be read soon. The processor sees by itself that a loop goes
/// through an array, but not beyond a page of 4 kB, and with many arrays it stands at the beginning
/// of one more often than not.
template <class Block>
void prefetch(const Block& block) {
  constexpr std::size_t line = 64;
  const char* const first = reinterpret_cast<const char*>(&block);
  for (std::size_t at = 0; at < sizeof(Block); at += line) __builtin_prefetch(first + at);
}

inline void square_root(const SimdDouble4& values, SimdDouble4& roots) {
  for (int l = 0; l < simd_width; ++l) roots[l] = std::sqrt(values[l]);
}

}  // namespace suffuse
