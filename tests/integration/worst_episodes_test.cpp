// The worst episodes on a campaign's page: what is linked, what is rendered.

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/campaign/store/folder_lock.hpp"
#include "tests/integration/campaign_fixture.hpp"

namespace qsmpc::harness {
namespace integration_worst_episodes_test {

namespace fs = std::filesystem;
using testing::files_below;
using testing::files_in;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProcessResult;
using testing::read_text;
using testing::run_qsmpc;
using testing::TemporaryFolder;

class WorstEpisodes : public ::testing::Test {
 protected:
  /// Two variants with two seeds, all of which time out; videos are small.
  void drive(const std::string& traces) {
    const std::string file = folder_.file("short.yaml",
                                          "name: short\n"
                                          "scenario: dubins_corridor\n"
                                          "variants:\n"
                                          "  closed: {}\n"
                                          "  open: {controller.policy: open_loop}\n"
                                          "grid: {limit.steps: [4], video.size: [160x120]}\n"
                                          "seeds: {first: 3, count: 2}\n"
                                          "traces: " +
                                              traces + "\n");
    const ProcessResult result = testing::run_qsmpc({"campaign", file, "--out", out_, "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }
  [[nodiscard]] std::string page() const { return testing::read_text(out_ + "/report.html"); }

  TemporaryFolder folder_;
  std::string out_ = folder_ / "out";
};

TEST_F(WorstEpisodes, whose_traces_are_kept_are_linked_with_the_commands_for_the_rest) {
  ASSERT_NO_FATAL_FAILURE(drive("all"));
  EXPECT_THAT(page(), HasSubstr("href=\"./episodes/1/4/episode.h5\""));
  EXPECT_THAT(page(), HasSubstr("<code>qsmpc render episodes/1/4</code>"));
  EXPECT_THAT(page(), Not(HasSubstr("qsmpc run")));
  EXPECT_FALSE(fs::exists(out_ + "/variants"));
  ASSERT_EQ(testing::run_qsmpc({"report", "episodes/1/4"}, {.folder = out_}).exit_code, 0);
  ASSERT_EQ(testing::run_qsmpc({"report", "."}, {.folder = out_}).exit_code, 0);
  EXPECT_THAT(page(), HasSubstr("href=\"./episodes/1/4/report.html\""));
  EXPECT_THAT(page(), Not(HasSubstr("<code>qsmpc report episodes/1/4</code>")));
}

TEST_F(WorstEpisodes, can_be_driven_by_the_command_on_the_page_and_are_linked_then) {
  ASSERT_NO_FATAL_FAILURE(drive("none"));
  EXPECT_THAT(page(), HasSubstr("<code>qsmpc run variants/1.yaml --seed 4 --out episodes/1/4<"));
  const ProcessResult run = testing::run_qsmpc(
      {"run", "variants/1.yaml", "--seed", "4", "--out", "episodes/1/4", "--no-video"},
      {.folder = out_});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  // Another trace in the place of an episode is not accepted as that episode.
  fs::copy(out_ + "/episodes/1/4", out_ + "/episodes/1/3");
  fs::create_directories(out_ + "/episodes/0/4");
  fs::copy(out_ + "/episodes/1/4/episode.h5", out_ + "/episodes/0/4/episode.h5");
  ASSERT_EQ(testing::run_qsmpc({"report", out_}).exit_code, 0);
  EXPECT_THAT(page(), HasSubstr("href=\"./episodes/1/4/report.html\""));
  EXPECT_THAT(page(), Not(HasSubstr("href=\"./episodes/1/3")));
  EXPECT_THAT(page(), Not(HasSubstr("href=\"./episodes/0")));
}

TEST_F(WorstEpisodes, get_their_pages_and_videos_driven_again_where_no_trace_is_kept) {
  ASSERT_NO_FATAL_FAILURE(drive("none"));
  const ProcessResult result = testing::run_qsmpc({"report", out_, "--worst", "2", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "") << "each ended as in the campaign";
  const std::vector<std::string> videos = testing::files_below(out_, "episode.mp4");
  ASSERT_EQ(videos.size(), 2U);
  for (const std::string& video : videos) {
    const std::string own = video.substr(0, video.rfind('/'));
    EXPECT_EQ(testing::files_in(out_ + "/" + own),
              (std::set<std::string>{"episode.h5", "episode.mp4", "report.html", "summary.json",
                                     "video.json"}));
    EXPECT_THAT(page(), HasSubstr("href=\"./" + own + "/report.html\">page<"));
    EXPECT_THAT(page(), HasSubstr("href=\"./" + video + "\">video<"));
  }
  const std::string video = out_ + "/" + videos[0];
  const auto before = fs::last_write_time(video);
  ASSERT_EQ(testing::run_qsmpc({"report", out_, "--worst", "1", "--quiet"}).exit_code, 0);
  EXPECT_EQ(fs::last_write_time(video), before) << "a video that is there is not made again";
}

TEST_F(WorstEpisodes, are_shown_for_a_campaign_that_is_not_running) {
  ASSERT_NO_FATAL_FAILURE(drive("none"));
  {
    const FolderLock lock(out_);
    const ProcessResult result = testing::run_qsmpc({"report", out_, "--worst", "1"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(testing::files_below(out_, "episode.h5"), ::testing::IsEmpty());
  }
  const ProcessResult elsewhere = testing::run_qsmpc({"report", folder_.path(), "--worst", "1"});
  EXPECT_EQ(elsewhere.exit_code, 2);
  EXPECT_THAT(elsewhere.errors, HasSubstr("--worst"));
  EXPECT_EQ(testing::run_qsmpc({"report", out_, "--worst", "0"}).exit_code, 2);
}

}  // namespace integration_worst_episodes_test
}  // namespace qsmpc::harness
