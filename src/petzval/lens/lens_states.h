// SPDX-License-Identifier: BSD-3-Clause
// Zoom and focus positions: one lens in several states.
#pragma once

#include <petzval/lens/lens_file.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// The lens set to one of its states.
///
///     Lens zoom = read_lens("wide-zoom").lens;
///     Lens tele = in_state(zoom, "tele");
///     Lens between = in_state(zoom, "0.5");
///
/// \param state  a name, or a number counted from 0. Between two numbers lengths, angles and f-numbers stand
/// in proportion, radii by their curvatures and the object's distance by its reciprocal; what is no number
/// must be the same in both neighbours.
/// \param options  where glasses are looked for beside those of the lens; substitutions are not used.
/// \throws InputError if there is no such state, or what it sets is no lens.
Lens in_state(const Lens& lens, const std::string& state, const LensReadOptions& options = {});
/// The same by number, 0 to the number of states − 1.
Lens in_state(const Lens& lens, double number, const LensReadOptions& options = {});

/// The state that the lens stands in, if every value of one is as it says; the first of those that are.
std::optional<std::size_t> present_state(const Lens& lens);

/// One lens out of several that differ in numbers and glasses: it stands in the first, and its states say in
/// which entries the others differ. Names and sources are those of the first.
/// \throws InputError if they differ in their number of surfaces, or there are not as many names as lenses.
Lens joined_states(std::vector<std::string> names, const std::vector<Lens>& lenses);

/// The states that lenses are, of a lens that need not stand in any of them. \throws InputError as
/// joined_states().
LensStates states_beside(const Lens& lens, std::vector<std::string> names, std::vector<Lens> lenses);

/// Does something to a lens and, where it has states, to each of them.
Lens in_every_state(const Lens& lens, const std::function<Lens(const Lens&)>& alter);

}  // namespace petzval
