// From the arrays that a step is handed to its bodies: free velocities, predicted centres, free spins.
#pragma once

#include "state.hpp"

namespace nscd {

// Fills spheres, bodies, spins and the scales of the step: `smooth_kick`, `watch`. Contacts will be sought at
// q_k + prediction dt v_k, and look_ahead (0 or 1) times dt |v| around. Returns the largest speed before or after the
// smooth forces, m/s. Raises Error for a grain that cannot be integrated.
double gather(State &state, double prediction, double look_ahead);

}    // namespace nscd
