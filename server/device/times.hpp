/// @file times.hpp
/// How long a device waits for whom, all in one place. What the controller's firmware waits for is in
/// firmware/protocol/session.h.
#pragma once

namespace sinew::server::device::times {

/// [s] without a word from the page that ends a motion.
constexpr double button = 0.3;
/// [s] without a word from the page that end its lease: a page may stall for a screenshot or a garbage
/// collection, in which nothing moves, without having to arm anew.
constexpr double lease = 2;
/// [s] of set-points, and of measurements.
constexpr double period = 0.02;
/// [s] of frames to the pages.
constexpr double frame = 0.05;
/// [s] that an answer of the controller may take, and that a measurement counts as new: three frames. Below
/// the 200 ms of silence after which the firmware lets go by itself.
constexpr double answer = 3 * frame;
/// [s] without motion that disarm.
constexpr double armed = 60;
/// [s] that are recorded after disarming.
constexpr double tail = 1;

}  // namespace sinew::server::device::times
