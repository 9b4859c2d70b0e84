#include "solve/newton.hpp"

namespace sinew::inline v1::detail {

template bool newton_step<3>(const Linearised<3>& system, Vec<double, 3>& step);
template bool newton_step<6>(const Linearised<6>& system, Vec<double, 6>& step);
template bool newton_step<8>(const Linearised<8>& system, Vec<double, 8>& step);
template Vec<double, 3> damped_step<3>(const Linearised<3>& system, double damping);
template Vec<double, 6> damped_step<6>(const Linearised<6>& system, double damping);
template Vec<double, 8> damped_step<8>(const Linearised<8>& system, double damping);

}  // namespace sinew::inline v1::detail
