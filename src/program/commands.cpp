#include "program/command.hpp"

#include <array>

namespace raytruth {

extern const Command advise_command;
extern const Command compare_command;
extern const Command completion_command;
extern const Command diff_command;
extern const Command eval_command;
extern const Command info_command;
extern const Command judge_command;
extern const Command ledger_command;
extern const Command list_command;
extern const Command manual_command;
extern const Command merge_command;
extern const Command plot_command;
extern const Command render_command;
extern const Command rules_command;
extern const Command run_command;
extern const Command score_command;
extern const Command table_command;
extern const Command transfer_command;
extern const Command vectors_command;

std::span<const Command* const> commands() {
  static constexpr std::array list{&run_command,      &merge_command,   &list_command,      &eval_command,
                                   &render_command,   &advise_command,  &compare_command,   &table_command,
                                   &rules_command,    &plot_command,    &diff_command,      &info_command,
                                   &transfer_command, &vectors_command, &score_command,     &judge_command,
                                   &ledger_command,   &manual_command,  &completion_command};
  return list;
}

}  // namespace raytruth
