/// @file plane_axes.hpp
/// Which numbers of a twist or a wrench in space one in the plane z = 0 has: along x and y, and about z.
#pragma once
#include <array>
#include <cstddef>

namespace sinew::inline v1 {

inline constexpr std::array<std::size_t, 3> plane_axes{0, 1, 5}, axes_out_of_plane{2, 3, 4};

}  // namespace sinew::inline v1
