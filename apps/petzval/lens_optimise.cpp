// SPDX-License-Identifier: BSD-3-Clause
// petzval lens optimise.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/quantities.h>
#include <petzval/lens/lens_file.h>
#include <petzval/report/optimise_tables.h>

#include <memory>

#include "field_option.h"
#include "lens_commands.h"
#include "output_option.h"
#include "plot_output.h"
#include "table_output.h"

namespace petzval::app {

namespace {

struct OptimiseCommand {
  LensChoice lens;
  FieldChoice fields;
  OptimiseRequest request;
  std::vector<std::string> variables;
  std::string merit = "spot", weights, azimuths, plot, output;
};

void print_as_json(const OptimiseCommand& command, const OptimiseRequest& request,
                   const OptimiseResult& result) {
  nlohmann::ordered_json json = {{"lens", result.lens.name},
                                 {"output", command.output},
                                 {"merit", name_of(request.merit)},
                                 {"unit", unit_of(request.merit)},
                                 {"before", result.before},
                                 {"after", result.after},
                                 {"efl_before_mm", result.efl_before_mm},
                                 {"efl_after_mm", result.efl_after_mm},
                                 {"start", result.start},
                                 {"by_round", result.by_round},
                                 {"field", field_definition(request.at.field_kind)},
                                 {"rows", rows_json(optimised_fields(result, request.at, request.merit))},
                                 {"numbers", rows_json(optimised_numbers(result))}};
  if (request.glasses > 0) json["glasses"] = rows_json(optimised_glasses(result));
  print_json(json);
}

void print_as_text(const OptimiseCommand& command, const OptimiseRequest& request,
                   const OptimiseResult& result) {
  fmt::print("{}: {} {:.4g} {}, was {:.4g}, after {} rounds{}\n", command.output, name_of(request.merit),
             result.after, unit_of(request.merit), result.before, result.by_round.size() - 1,
             result.start == 0 ? "" : fmt::format(" from start {}", result.start));
  fmt::print("focal length {:.6g} mm, was {:.6g} mm\n\n", result.efl_after_mm, result.efl_before_mm);
  print_table(optimised_fields(result, request.at, request.merit));
  fmt::print("\n");
  print_table(optimised_numbers(result));
  if (request.glasses == 0) return;
  fmt::print("\n");
  if (result.glasses.empty())
    fmt::print("no glass among the {} nearest of each is better\n", request.glasses);
  else
    print_table(optimised_glasses(result));
}

OptimiseMerit optimise_merit(const std::string& text, double& frequency_cpmm) {
  constexpr std::string_view mtf = "mtf@";
  if (text == "spot") return OptimiseMerit::rms_spot;
  if (text == "wavefront") return OptimiseMerit::wavefront;
  const auto number = text.starts_with(mtf) ? parse_number(text.substr(mtf.size())) : std::nullopt;
  if (!number || !(*number > 0))
    throw InputError(fmt::format(
        "--merit \"{}\": spot, wavefront, or mtf@40 for the MTF at 40 cycles/mm, would be right", text));
  frequency_cpmm = *number;
  return OptimiseMerit::mtf;
}

void run_optimise(const OptimiseCommand& command, const Shared& shared) {
  if (!command.plot.empty()) require_drawing(command.plot, "a plot");
  OptimiseRequest request = command.request;
  request.merit = optimise_merit(command.merit, request.mtf_frequency_cpmm);
  const Lens lens = command.fields.prepare(command.lens.read(shared), shared);
  for (const std::string& text : command.variables)
    for (const LensVariable& variable : parse_lens_variables(lens, text))
      request.variables.push_back(variable);
  request.at = command.fields.request(lens);
  if (!command.weights.empty()) request.field_weights = parse_number_list(command.weights, "field_weights");
  if (!command.azimuths.empty()) request.azimuths_deg = parse_number_list(command.azimuths, "azimuths_deg");
  const OptimiseResult result = optimise(lens, request, context_of(shared));
  if (!command.plot.empty())
    write_drawing(command.plot, optimise_plot(result.lens.name, result, request.merit).svg());
  for (const std::string& line : write_lens(result.lens, command.output)) note(shared, line);
  if (shared.json)
    print_as_json(command, request, result);
  else if (!shared.quiet)
    print_as_text(command, request, result);
}

}  // namespace

void add_lens_optimise(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<OptimiseCommand>();
  CLI::App* command = add_command(
      lens, shared, "optimise", "Alter numbers of a lens until its rays meet more closely",
      "petzval lens optimise cooke-triplet --variable radii --variable gaps --variable image -o better.json",
      true, [options, &shared] { run_optimise(*options, shared); });
  OptimiseRequest& request = options->request;
  options->lens.add_to(*command);
  command
      ->add_option("--variable", options->variables,
                   "What may be altered: radii, thicknesses, gaps, image, poses, or one number such as "
                   "surfaces[1].conic or groups[0].pose.tilt_x_deg, with =LOW:HIGH for limits (repeatable); "
                   "default: radii and image")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option(
      "--merit", options->merit,
      "What is made small: spot (RMS radius), wavefront, or what the MTF lacks of 1, mtf@F at F "
      "cycles/mm; default: spot");
  command
      ->add_option("--most-distortion", request.most_distortion_percent,
                   "Of every field, about the paraxial height [%]; default: it does not count")
      ->check(number_not_negative());
  command->add_option("--efl", request.efl_mm, "The focal length that it shall have [mm]; default: as it has")
      ->check(finite_number());
  options->fields.add_to(*command);
  command->add_option("--azimuths", options->azimuths,
                      "At which the fields count [degrees]; default: 0,90,180,270 where the lens is not "
                      "round or poses may be altered");
  command->add_option("--field-weights", options->weights, "One for every field; default: all alike");
  command
      ->add_option("--least-rim", request.least_rim_mm, "Of glass at the clear aperture [mm]; default: 0.5")
      ->check(number_not_negative());
  command->add_option("--rounds", request.rounds, "At most; default: 30")->check(CLI::Range(1, 1000));
  command
      ->add_option("--starts", request.starts,
                   "Also begin beside the lens, so many starts in all; the best result counts; default: 1")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--start-spread", request.start_spread,
                   "How far beside: a share of every number; default: 0.05")
      ->check(positive_number());
  command
      ->add_option(
          "--glasses", request.glasses,
          "Also try so many glasses of the same maker, the nearest by nd and Vd, in the place of each; "
          "default: 0, glasses stay")
      ->check(CLI::Range(0, 100));
  command->add_option("--plot", options->plot, "Also draw the merit by round: .svg, .png or .pdf")
      ->check(output_file());
  command->add_option("-o,--output", options->output, "Lens file to write; its extension tells the format")
      ->check(output_file())
      ->required();
}

}  // namespace petzval::app
