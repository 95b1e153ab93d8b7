// One function per subcommand: it adds the command's options to the parser. If the command is
// given, the callback runs it and stores its exit code.
#pragma once

namespace CLI {
class App;
}

namespace qsmpc::harness {

/// The largest value of --jobs and --threads.
inline constexpr int kMostAtOnce = 1024;

void add_run_command(CLI::App& app, int& exit_code);
void add_predict_command(CLI::App& app, int& exit_code);
void add_campaign_command(CLI::App& app, int& exit_code);
/// `campaign` is the parent command of these.
void add_campaign_status_command(CLI::App& campaign, int& exit_code);
void add_campaign_merge_command(CLI::App& campaign, int& exit_code);
void add_campaign_tasks_commands(CLI::App& campaign, int& exit_code);
/// `app` must outlive the parsing: its commands are completed.
void add_completion_command(CLI::App& app, int& exit_code);
void add_compare_command(CLI::App& app, int& exit_code);
void add_contest_command(CLI::App& app, int& exit_code);
void add_export_command(CLI::App& app, int& exit_code);
void add_fit_command(CLI::App& app, int& exit_code);
void add_render_command(CLI::App& app, int& exit_code);
void add_reproduce_command(CLI::App& app, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
void add_doctor_command(CLI::App& app, int& exit_code);
/// `app` must outlive the parsing: its commands are explained.
void add_help_command(CLI::App& app, int& exit_code);
void add_init_command(CLI::App& app, int& exit_code);
void add_list_command(CLI::App& app, int& exit_code);
void add_schema_command(CLI::App& app, int& exit_code);
void add_validate_command(CLI::App& app, int& exit_code);

}  // namespace qsmpc::harness
