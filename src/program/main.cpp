#include "experiments/output.hpp"
#include "experiments/version.hpp"
#include "program/commands.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <csignal>
#include <exception>
#include <functional>
#include <new>
#include <stdexcept>

namespace raytruth {

namespace {

constexpr int bad_input = 2;
constexpr int missing = 3;
constexpr int most_threads = 9999;

/// The command line: options end up in the structures of commands.hpp, and `chosen` becomes the command to call.
class CommandLine {
 public:
  CommandLine() {
    program_.require_subcommand(1);
    program_.set_version_flag("--version", fmt::format("raytruth {} ({})", version, commit));
    program_.footer("Exit codes: 0 done; 1 a bound does not hold (--check); 2 bad input; 3 something is missing here.");
    add_run();
    add_list();
    add_eval();
    add_render();
    add_compare();
    add_table();
    add_plot();
    add_diff();
    add_info();
    add_vectors();
    add_score();
    add_ledger();
  }

  /// Returns the exit code.
  int run(int argc, char** argv) {
    try {
      program_.parse(argc, argv);
    } catch (const CLI::Success& request) {  // --help, --version
      std::ostringstream text;
      program_.exit(request, text, text);
      print(text.str() + (text.str().ends_with('\n') ? "" : "\n"));
      return 0;
    } catch (const CLI::ParseError& error) {
      if (program_.get_subcommands().empty() && argc > 1) refuse_command(argv[1]);
      throw InputError(fmt::format("command line: {}; `raytruth --help` tells what is allowed", error.what()));
    }
    return chosen_();
  }

 private:
  template <class Options>
  CLI::App* add_command(const char* name, const char* summary, const char* example, Options& options,
                        int (*command)(const Options&)) {
    CLI::App* const added = program_.add_subcommand(name, summary);
    added->footer(fmt::format("Example:\n  {}", example));
    added->callback([this, &options, command] { chosen_ = [&options, command] { return command(options); }; });
    return added;
  }

  [[noreturn]] void refuse_command(std::string_view found) {
    std::vector<std::string> names;
    for (const CLI::App* command : program_.get_subcommands({})) names.push_back(command->get_name());
    const auto closest = closest_word(found, names);
    throw InputError(fmt::format("command line: found {}{}; one of {} is allowed", found,
                                 closest.empty() ? "" : fmt::format(" (perhaps {})", closest), fmt::join(names, ", ")));
  }

  static void add_data(CLI::App& command, std::string& data) {
    command.add_option("--data", data, "Folders of volumes, separated by ':'; before those of RAYTRUTH_DATA")
        ->type_name("DIR");
  }

  static void add_threads(CLI::App& command, int& threads) {
    command.add_option("-j", threads, "Threads to use (default: all cores)")
        ->type_name("N")
        ->check(CLI::Range(1, most_threads));
  }

  template <class Seed>
  static void add_seed(CLI::App& command, Seed& seed, const char* summary) {
    command.add_option("--seed", seed, summary)
        ->type_name("S")
        ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
  }

  void add_run() {
    auto& command =
        *add_command("run", "Run experiments", "raytruth run experiments/xi_adaptive.json -o out --profile quick", run_,
                     run_experiments);
    command.add_option("experiment", run_.experiments, "JSON files; '-' is standard input")->required();
    command.add_option("-o", run_.folder, "Write NAME.json into this folder (default: to standard output)")
        ->type_name("DIR");
    add_threads(command, run_.threads);
    command.add_option("--profile", run_.profile, "quick: a smaller version, in seconds (default: full)")
        ->type_name("NAME")
        ->check(CLI::IsMember({"quick", "full"}));
    add_seed(command, run_.seed, "Instead of the experiment's");
    command.add_option("--gl", run_.gl, "Run shaders by osmesa or by egl, a GPU's driver (default: the experiment's)")
        ->type_name("NAME")
        ->check(CLI::IsMember({"osmesa", "egl"}));
    command.add_flag("--check", run_.check, "Exit with 1 if a bound that the experiment states does not hold");
    command.add_flag("--resume", run_.resume, "Finish an interrupted run; needs -o");
    add_data(command, run_.data);
  }

  void add_list() {
    auto& command = *add_command("list", "List what there is", "raytruth list schemes --json", list_, list_ingredients);
    command.add_option("kind", list_.kind, "Of what (default: everything)")->check(CLI::IsMember(listed_kinds()));
    command.add_flag("--json", list_.json, "As JSON");
  }

  void add_eval() {
    auto& command =
        *add_command("eval", "Evaluate one ray, slab or scene, or an array of them, by the schemes they name",
                     "raytruth eval ray.json", eval_, evaluate_cases);
    command.add_option("case", eval_.file, "JSON file; '-' is standard input")->required();
    add_threads(command, eval_.threads);
    add_data(command, eval_.data);
  }

  void add_table() {
    auto& command = *add_command("table", "Make a pre-integration table for a renderer, and measure its error",
                                 "raytruth table table.json -o table.npy", table_, write_table);
    command.add_option("case", table_.table_case, "JSON file; '-' is standard input")->required();
    command.add_option("-o", table_.file, "Write this file, .npy or .nrrd, and FILE.json beside it, with its error")
        ->type_name("FILE")
        ->required();
    add_threads(command, table_.threads);
    command.footer(fmt::format(
        "A case:\n"
        "  {{\"transfer_function\": {{\"points\": [{{\"s\": 0, \"extinction\": 0, \"color\": [0, 0, 0]}},\n"
        "                                    {{\"s\": 255, \"extinction\": 2, \"color\": [1, 0.5, 0.2]}}]}},\n"
        "   \"builder\": \"exact\", \"size\": 256, \"length\": 1, \"range\": [0, 255], \"format\": \"float32\"}}\n\n"
        "`raytruth list tables` tells the builders; beside them there are, for slabs whose scalar is a parabola,\n"
        "second_order_iterations (with \"iterations\"), second_order_nyquist and second_order_exact, and psi of\n"
        "Moreland and Angel, partial_pre_integration, of \"builder\", \"size\" and \"format\" alone.\n\n{}",
        command.get_footer()));
  }

  void add_render() {
    auto& command = *add_command("render", "Render a scene, by any scheme or certified",
                                 "raytruth render scene.json -o image.png", render_, render_scene);
    command.add_option("scene", render_.scene, "JSON file; '-' is standard input")->required();
    command
        .add_option("-o", render_.file, "The image: .png (8 bits, over black), .pfm or .npy (linear light, binary32)")
        ->type_name("FILE")
        ->required();
    add_threads(command, render_.threads);
    command.add_flag("--linear", render_.is_linear, "Write linear light into a .png, instead of sRGB");
    command
        .add_option("--opacity", render_.opacity,
                    "Take the opacities of this transfer function, for colour maps without")
        ->type_name("FILE");
    command.add_flag("--ignore-gradient-opacity", render_.ignores_gradient_opacity,
                     "Accept transfer functions whose opacity depends on the gradient, and leave that out");
    add_data(command, render_.data);
  }

  void add_compare() {
    auto& command = *add_command("compare", "Tell how far an image is from a reference",
                                 "raytruth compare truth.pfm image.pfm", compare_, compare_images);
    command.add_option("reference", compare_.reference, ".pfm, .npy or .png (its stored values)")->required();
    command.add_option("image", compare_.image, "An image of the same size")->required();
    command.add_option("--difference", compare_.difference, "Write the magnitudes of the differences into this image")
        ->type_name("FILE");
    command.add_option("--gain", compare_.gain, "Times this (default: 1)")->type_name("X")->check(CLI::PositiveNumber);
    command.footer(fmt::format(
        "Colours are clamped to [0, 1]; PSNR has the peak 1. `danskin_hanrahan` is 100 sum |I - R| / sum R, in\n"
        "percent; `ssim` that of Wang et al. 2004, windows of 11 x 11.\n\n{}",
        command.get_footer()));
  }

  void add_plot() {
    auto& command = *add_command("plot", "Draw the plots of results", "raytruth plot results/xi_adaptive.json -o plots",
                                 plot_, plot_results);
    command.add_option("result", plot_.results, "JSON files")->required();
    command.add_option("-o", plot_.folder, "Write NAME.FORMAT into this folder (default: the current one)")
        ->type_name("DIR");
    command.add_option("--format", plot_.format, "svg (default), png or pdf")
        ->type_name("NAME")
        ->check(CLI::IsMember({"svg", "png", "pdf"}));
  }

  void add_diff() {
    auto& command = *add_command("diff", "Tell what changed between two results, beyond both radii",
                                 "raytruth diff results/xi_adaptive.json out/xi_adaptive.json", diff_, compare_results);
    command.add_option("before", diff_.before, "JSON file")->required();
    command.add_option("after", diff_.after, "JSON file")->required();
    command.add_flag("--json", diff_.json, "As JSON");
    command.add_flag("--check", diff_.check, "Exit with 1 if something changed");
  }

  void add_info() {
    auto& command = *add_command("info", "Describe a volume: header, range, levels in use, signs of damage",
                                 "raytruth info ch2.nii.gz", info_, show_volume);
    command.add_option("volume", info_.volume, "File, or name in the data folders")->required();
    command.add_flag("--json", info_.json, "As JSON");
    add_data(command, info_.data);
  }

  void add_vectors() {
    auto& command = *add_command(
        "vectors", "Write the conformance vectors: rays and slabs with certified colour and opacity, for any renderer",
        "raytruth vectors -o vectors.json", vectors_, write_vectors);
    command.add_option("-o", vectors_.file, "Write this file (default: to standard output)")->type_name("FILE");
    add_seed(command, vectors_.seed, "Other vectors of the same levels (default: 1)");
  }

  void add_score() {
    auto& command = *add_command("score", "Count the digits that are right in a program's answers to the vectors",
                                 "raytruth score vectors.json answers.csv", score_, score_answers);
    command.add_option("vectors", score_.vectors, "JSON file, written by `raytruth vectors`")->required();
    command.add_option("answers", score_.answers, "CSV file with the header id,r,g,b,opacity; '-' is standard input")
        ->required();
    command.add_flag("--json", score_.json, "As JSON");
    command.footer(fmt::format(
        "Digits of an answer: -log10(error / scale), of colour and opacity the lesser one. The colour's\n"
        "error is that of its worst channel, its scale the largest channel of the certified colour; the\n"
        "opacity's scale is the certified opacity. Errors below the certified error_bound, or 2^-53 of the\n"
        "scale, count as that much; errors above the scale have no digits, nor has a vector without an\n"
        "answer. Ids that are not in the vectors are refused.\n\n{}",
        command.get_footer()));
  }

  void add_ledger() {
    auto& command = *add_command("ledger", "Collect the verdicts of results on the publications' claims",
                                 "raytruth ledger --page plots/ledger.html", ledger_, keep_ledger);
    command.add_option("result", ledger_.results, "JSON files (default: those in results/)");
    command.add_option("-o", ledger_.file, "Write the ledger, a result, to this file (default: results/ledger.json)")
        ->type_name("FILE");
    command.add_option("--page", ledger_.page, "Write a page for people too, with the experiments' plots")
        ->type_name("FILE");
    command.add_option("--plots", ledger_.plots, "Where the page's plots are, NAME.svg (default: plots)")
        ->type_name("DIR");
  }

  CLI::App program_{"Exact rays through volumes, and how far the schemes of volume rendering are from them.",
                    "raytruth"};
  RunOptions run_;
  ListOptions list_;
  EvalOptions eval_;
  RenderOptions render_;
  CompareOptions compare_;
  TableOptions table_;
  PlotOptions plot_;
  DiffOptions diff_;
  InfoOptions info_;
  VectorsOptions vectors_;
  ScoreOptions score_;
  LedgerOptions ledger_;
  std::function<int()> chosen_;
};

int run_program(int argc, char** argv) {
  try {
    // A reader that stops early, as `head` does, shows as an error of writing.
    std::signal(SIGPIPE, SIG_IGN);
    return CommandLine().run(argc, argv);
  } catch (const InputError& error) {
    say(error.what());
    return bad_input;
  } catch (const MissingError& error) {
    say(error.what());
    return missing;
  } catch (const std::bad_alloc&) {
    say("this needs more memory than the machine has");
    return missing;
  } catch (const std::exception& error) {
    say(fmt::format("this should not have happened: {}", error.what()));
    return bad_input;
  }
}

}  // namespace

}  // namespace raytruth

int main(int argc, char** argv) { return raytruth::run_program(argc, argv); }
