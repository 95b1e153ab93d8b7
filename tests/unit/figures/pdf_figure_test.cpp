#include "harness/figures/pdf_figure.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include <gtest/gtest.h>

#include "harness/figures/svg_figure.hpp"
#include "harness/files/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace pdf_figure_test {

using testing::contains;
using testing::TemporaryFolder;

Chart example() {
  return {.title = "Distance to the goal",
          .note = "A note with a µ.",
          .x_label = "time (s)",
          .y_label = "distance (m)",
          .series = {{.name = "plant", .x = {1, 2, 3}, .y = {0.1, 0.3, 0.2}},
                     {.name = "model", .colour = 1, .x = {1, 2, 3}, .y = {0.1, 0.2, 0.1}}}};
}

/// The output of a poppler program about the file.
std::string output_of(const std::string& command) {
  std::string output;
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return "no pipe";
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    output.append(buffer.data(), n);
  }
  return ::pclose(pipe) == 0 ? output : "failed: " + output;
}

TEST(PdfFigure, has_one_page_of_the_figures_size_with_its_texts_and_fonts) {
  const std::string svg = svg_figure({example()});
  const std::string pdf = pdf_figure(svg, "Distance");
  ASSERT_TRUE(pdf.starts_with("%PDF-"));
  const TemporaryFolder folder;
  const std::string path = folder.file("figure.pdf", pdf);
  const std::string info = output_of("pdfinfo " + path);
  EXPECT_TRUE(testing::contains(info, "Pages:           1\n")) << info;
  EXPECT_TRUE(testing::contains(info, "Title:           Distance\n")) << info;
  const double height = std::stod(svg.substr(svg.find("height=\"") + 8));
  const std::string size = info.substr(info.find("Page size:") + 16);
  EXPECT_DOUBLE_EQ(std::stod(size), 508 * 0.75) << info;
  EXPECT_NEAR(std::stod(size.substr(size.find('x') + 1)), height * 0.75, 1e-3) << info;
  const std::string text = output_of("pdftotext " + path + " -");
  for (const char* words :
       {"Distance to the goal", "time (s)", "distance (m)", "A note with a µ.", "model"}) {
    EXPECT_TRUE(testing::contains(text, words)) << words << " is not in\n" << text;
  }
  const std::string fonts = output_of("pdffonts " + path);
  EXPECT_TRUE(testing::contains(fonts, "LiberationSans")) << fonts;
  EXPECT_EQ(testing::occurrences(fonts, "yes yes yes"), testing::occurrences(fonts, "\n") - 2)
      << "two lines of heads; all fonts embedded, with letters that can be copied\n"
      << fonts;
  const std::string images = output_of("pdfimages -list " + path);
  EXPECT_EQ(testing::occurrences(images, "\n"), 2) << "a head alone: all is vectors\n" << images;
}

TEST(PdfFigure, of_the_same_input_is_the_same_bytes_and_has_no_present_date) {
  const std::string svg = svg_figure({example()});
  const std::string pdf = pdf_figure(svg, "Distance");
  EXPECT_TRUE(pdf == pdf_figure(svg, "Distance"));
  const TemporaryFolder folder;
  const std::string info = output_of("pdfinfo -rawdates " + folder.file("figure.pdf", pdf));
  EXPECT_TRUE(testing::contains(info, "CreationDate:    20000101000000")) << info;
  EXPECT_FALSE(testing::contains(info, "ModDate")) << info;
}

TEST(PdfFigure, refuses_what_is_not_a_figure) {
  EXPECT_THROW((void)pdf_figure("no drawing", ""), std::invalid_argument);
  EXPECT_THROW((void)pdf_figure("", ""), std::invalid_argument);
  EXPECT_THROW((void)pdf_figure("<svg xmlns=\"http://www.w3.org/2000/svg\"/>", ""),
               std::invalid_argument);
}

}  // namespace pdf_figure_test
}  // namespace qsmpc::harness
