// SPDX-License-Identifier: BSD-3-Clause
// petzval lens scale.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/scaled_lens.h>

#include <cmath>
#include <memory>
#include <optional>

#include "lens_commands.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct ScaleCommand {
  LensChoice lens;
  std::optional<double> factor, efl_mm;
  std::string output;
};

void scale(const ScaleCommand& options, const Shared& shared) {
  if (options.factor.has_value() == options.efl_mm.has_value())
    throw InputError("lens scale needs either --factor or --efl");
  const Lens lens = options.lens.read(shared);
  const double efl_mm = std::abs(first_order(lens).efl_mm);
  const double factor = options.factor ? *options.factor : *options.efl_mm / efl_mm;
  Lens scaled = scaled_lens(lens, factor);
  scaled.name = fmt::format("{}, scaled by {:.4g}", lens.name, factor);
  for (const std::string& line : write_lens(scaled, options.output)) note(shared, line);
  if (shared.quiet) return;
  fmt::print("{}: focal length {:.6g} mm, was {:.6g} mm\n", options.output, first_order(scaled).efl_mm,
             first_order(lens).efl_mm);
}

}  // namespace

void add_lens_scale(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<ScaleCommand>();
  CLI::App* command =
      add_command(lens, shared, "scale",
                  "Write a lens with all its lengths multiplied: focal length, object distance, "
                  "apertures and field heights; f-number and angles stay",
                  "petzval lens scale double-gauss --factor 0.5 -o half.json", false,
                  [options, &shared] { scale(*options, shared); });
  options->lens.add_to(*command);
  command->add_option("--factor", options->factor, "What every length is multiplied by")
      ->check(positive_number());
  command->add_option("--efl", options->efl_mm, "The focal length that it shall have [mm]")
      ->check(positive_number());
  command->add_option("-o,--output", options->output, "Lens file to write; its extension tells the format")
      ->check(output_file())
      ->required();
}

}  // namespace petzval::app
