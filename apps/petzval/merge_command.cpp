// SPDX-License-Identifier: BSD-3-Clause
// petzval merge: the pieces of a picture that several processes have made.
#include <fmt/format.h>
#include <petzval/simulate/image_pieces.h>
#include <petzval/simulate/render.h>

#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct MergeCommand {
  std::vector<std::string> pieces;
  std::string output;
};

void merge(const MergeCommand& options, const Shared& shared) {
  const bool bands = is_image_piece(options.pieces.front());
  (bands ? merge_images : merge_renderings)(options.pieces, options.output, context_of(shared));
  if (!shared.quiet)
    fmt::print("{}: {} pieces; petzval {} with --checkpoint {} writes the picture\n", options.output,
               options.pieces.size(), bands ? "image" : "render", options.output);
}

}  // namespace

void add_merge_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<MergeCommand>();
  CLI::App* command = add_command(app, shared, "merge", "Put the pieces of a picture together",
                                  "petzval merge left.sums right.sums -o whole.sums", false,
                                  [=, &shared] { merge(*options, shared); });
  command
      ->add_option("pieces", options->pieces,
                   "Checkpoints of petzval render with --region or --sample-range, or of petzval image with "
                   "--bands, in any order")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "The checkpoint that one process would have left, the same bytes: the same command "
                   "without a piece goes on from there")
      ->required()
      ->check(output_file());
}

}  // namespace petzval::app
