#include "harness/reproduction/results_table.hpp"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"
#include "harness/text/text_width.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kQuantityWidth = 74;
constexpr std::size_t kNumberWidth = 12;
constexpr int kDigits = 4;

std::string with_unit(const ResultRow& row) {
  return row.unit.empty() ? row.quantity : fmt::format("{} ({})", row.quantity, row.unit);
}

/// Plain ASCII, so that columns line up wherever they are printed.
std::string plain_number(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return "-";
  return fmt::format("{:.{}g}", *value, kDigits);
}

std::string experiment_text(const ExperimentResult& experiment) {
  std::string text =
      fmt::format("\n{}: {} ({:.1f} s)\n", experiment.name, experiment.title, experiment.seconds);
  text += fmt::format("  {}{:>{}}{:>{}}{:>{}}\n", padded("", kQuantityWidth), "published",
                      kNumberWidth, "here", kNumberWidth, "ratio", kNumberWidth);
  for (const ResultRow& row : experiment.rows) {
    text += fmt::format("  {}{:>{}}{:>{}}{:>{}}\n", padded(with_unit(row), kQuantityWidth),
                        plain_number(row.published), kNumberWidth, plain_number(row.here),
                        kNumberWidth, plain_number(ratio_of(row)), kNumberWidth);
  }
  for (const Claim& claim : experiment.claims) {
    text += fmt::format("  {} {}\n          {}\n", claim.holds ? "[holds]" : "[FAILS]",
                        claim.statement, claim.evidence);
  }
  return text;
}

/// `text` as part of a cell or a paragraph of Markdown.
std::string escape_markdown(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|' || c == '*' || c == '_' || c == '<' || c == '`' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string experiment_markdown(const ExperimentResult& experiment, const std::string& figures) {
  std::string text =
      fmt::format("\n## {}: {}\n", experiment.name, escape_markdown(experiment.title));
  for (const std::string& remark : experiment.remarks) {
    text += fmt::format("\n{}\n", escape_markdown(remark));
  }
  text += "\n| quantity | published | here | ratio | note |\n| --- | ---: | ---: | ---: | --- |\n";
  for (const ResultRow& row : experiment.rows) {
    text += fmt::format("| {} | {} | {} | {} | {} |\n", escape_markdown(with_unit(row)),
                        table_number(row.published), table_number(row.here),
                        table_number(ratio_of(row)), escape_markdown(row.note));
  }
  if (!experiment.claims.empty()) text += "\n| claim | holds | evidence |\n| --- | --- | --- |\n";
  for (const Claim& claim : experiment.claims) {
    text += fmt::format("| {} | {} | {} |\n", escape_markdown(claim.statement),
                        claim.holds ? "yes" : "**no**", escape_markdown(claim.evidence));
  }
  for (const ResultFigure& figure : experiment.figures) {
    text += fmt::format("\n![{}]({}/{})\n", escape_markdown(figure.title), figures, figure.file);
    if (!figure.caption.empty()) text += fmt::format("\n*{}*\n", escape_markdown(figure.caption));
  }
  return text;
}

}  // namespace

std::string table_number(std::optional<double> value) {
  return value && std::isfinite(*value) ? format_short(*value, kDigits) : "–";
}

std::string circumstances(const Reproduction& reproduction) {
  return fmt::format("{}, {} cores, {}; {} seeds a drive, {} threads; {:.0f} s in all",
                     printable(reproduction.machine.processor), reproduction.machine.cores,
                     reproduction.machine.compiler, reproduction.seeds, reproduction.threads,
                     reproduction.seconds);
}

std::string results_table(const Reproduction& reproduction) {
  std::string text = "reproduced: " + circumstances(reproduction) + "\n";
  for (const ExperimentResult& experiment : reproduction.experiments) {
    text += experiment_text(experiment);
  }
  return text;
}

std::string results_markdown(const Reproduction& reproduction, const std::string& figures) {
  std::string text =
      fmt::format("qsmpc {}; {}.\n", reproduction.version, circumstances(reproduction));
  for (const ExperimentResult& experiment : reproduction.experiments) {
    text += experiment_markdown(experiment, figures);
  }
  return text;
}

}  // namespace qsmpc::harness
