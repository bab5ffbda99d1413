// The page as text: what stands in it, and what may not. How it looks is tested in a browser.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "reports/reconstruction/reconstruction_folder.h"
#include "reports/text/json_node.h"
#include "tests/reports/sample_reconstruction.h"

namespace simbench::reports {
namespace {

std::vector<ReconstructionPicture> pictures() {
  return {{.pipeline = "yoon2021_both",
           .png = "\x89PNG",
           .desync_ms = 5,
           .errors = {.mean_cm = 2.4, .std_cm = 1.8, .median_cm = 2, .p95_cm = 5, .count = 9}},
          {.pipeline = "ntp_last_set",
           .png = "png",
           .desync_ms = 547,
           .errors = {.mean_cm = 8, .std_cm = 11, .median_cm = 6, .p95_cm = 30, .count = 9}}};
}

std::string reconstruction_page(const reconstruction::ReconstructionResults& results) {
  return reconstruction_html({.results = results,
                              .pictures = pictures(),
                              .command = {"bin/simbench", "reconstruct", "--scenario", "it's"}});
}

// Not HasSubstr: a failure would print the page, which is long.
bool page_has(const std::string& page, const std::string& part) {
  return page.find(part) != std::string::npos;
}

TEST(ReconstructionHtml, HasTheNumbersOfTheTable) {
  const std::string page = reconstruction_page(sample_reconstruction());
  for (const char* part :
       {"<th scope=\"row\" class=\"text\">ntp_last_set</th><td>8.00 [6.20, 12.50]</td>"
        "<td>9.70, too few seeds</td>",
        "3.33 [3.03, 4.83]", "No speed of the subject", "<td>66.7 %</td>", "<td>&gt; 100</td>",
        "<td>30.0</td><td>0.0100</td>", "oracle: seed 2: too little", "the mesh has 3 holes",
        "measures calibration and depth noise", "what desynchronisation costs a reconstruction",
        "simbench reconstruct --scenario &#39;it&#39;\\&#39;&#39;s&#39;"}) {
    EXPECT_TRUE(page_has(page, part)) << part;
  }
}

TEST(ReconstructionHtml, ShowsThePicturesInTheOrderOfTheTable) {
  const std::string page = reconstruction_page(sample_reconstruction());
  const std::size_t ntp = page.find("<img src=\"data:image/png;base64,cG5n\"");
  const std::size_t both = page.find("<img src=\"data:image/png;base64,iVBORw==\"");
  ASSERT_NE(ntp, std::string::npos);
  ASSERT_NE(both, std::string::npos);
  EXPECT_LT(ntp, both);
  EXPECT_TRUE(
      page_has(page, "yoon2021_both: 5.0 ms of desynchronisation, error 2.40 cm ± 1.80 cm"));
  EXPECT_TRUE(page_has(page, "10 cm and more"));
  EXPECT_TRUE(page_has(page, "linear-gradient(to right, rgb("));
}

TEST(ReconstructionHtml, HoldsTheFigureAsData) {
  const std::string page = reconstruction_page(sample_reconstruction());
  const std::string open = "<script type=\"application/json\" class=\"data\">";
  const std::size_t start = page.find(open) + open.size();
  const Json data = Json::parse(page.substr(start, page.find("</script>", start) - start));
  ASSERT_EQ(data["figures"].size(), 1U);
  EXPECT_EQ(data["figures"][0]["panels"].size(), 2U);
  EXPECT_EQ(data["figures"][0]["panels"][0]["series"][1]["label"], "1.20 m/s");
}

TEST(ReconstructionHtml, AsksNothingOfAnyServer) {
  const std::string page = reconstruction_page(sample_reconstruction());
  EXPECT_TRUE(page_has(page, "Content-Security-Policy\" content=\"default-src 'none'"));
  ASSERT_TRUE(page_has(page, "src="));
  for (std::size_t at = page.find("src="); at != std::string::npos;
       at = page.find("src=", at + 1)) {
    EXPECT_EQ(page.compare(at, 9, "src=\"data"), 0) << page.substr(at, 40);
  }
  // Only of the page's own parts.
  for (std::size_t at = page.find("url("); at != std::string::npos;
       at = page.find("url(", at + 1)) {
    EXPECT_EQ(page[at + 4], '#') << page.substr(at, 40);
  }
}

TEST(ReconstructionHtml, MarkupInNamesIsText) {
  const std::string evil = "</script><img src=x onerror=alert(1)>\"'&";
  auto results = sample_reconstruction();
  results.scenario.name = results.scenario.summary = evil;
  results.scenario.resolved_json = scenarios::Lazy<std::string>(evil);
  results.notes = {evil};
  for (auto& row : results.rows) row.pipeline = row.host_sync = row.gathering = evil;
  results.speed_needed->pipeline = evil;
  const std::string page = reconstruction_html(
      {.results = results,
       .pictures = {{.pipeline = evil, .png = "x", .desync_ms = 1, .errors = {}}},
       .command = {"simbench", evil}});
  EXPECT_FALSE(page_has(page, "<img src=x"));
  EXPECT_FALSE(page_has(page, "</script><img"));
}

TEST(ReconstructionHtml, WithoutPicturesOrCurveTheirPartsAreLeftOut) {
  auto results = sample_reconstruction();
  results.curve.clear();
  results.speed_needed.reset();
  const std::string page = reconstruction_html(
      {.results = results, .pictures = {}, .command = {"simbench", "reconstruct"}});
  EXPECT_FALSE(page_has(page, "What the reconstruction looks like"));
  EXPECT_FALSE(page_has(page, "How good must my"));
  EXPECT_TRUE(page_has(page, "the curve was not requested"));
}

}  // namespace
}  // namespace simbench::reports
