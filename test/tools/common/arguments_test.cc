#include "tools/common/arguments.h"

#include "support/catch.h"

using namespace leonav;

namespace {
Arguments sample() {
  Arguments a("tool", "FILE", "Does a thing.");
  a.option("--out", "DIR", "where to")
      .option("--rate", "HZ", "how often", "1")
      .flag("--fast", "hurry");
  return a;
}
}  // namespace

TEST_CASE("options, defaults, repeats and positional words") {
  Arguments a = sample();
  const char* argv[] = {"tool", "--out", "x", "file", "--out=y", "--", "--fast"};
  REQUIRE(a.parse(7, argv));
  CHECK(a.get("--out") == "y");
  CHECK(a.all("--out") == std::vector<std::string>{"x", "y"});
  CHECK(a.number("--rate") == 1.0);
  CHECK_FALSE(a.has("--fast"));
  CHECK(a.positional() == std::vector<std::string>{"file", "--fast"});
}

TEST_CASE("wrong words name the nearest right one") {
  Arguments a = sample();
  const char* misspelt[] = {"tool", "--rat", "5"};
  CHECK_THROWS_WITH(a.parse(3, misspelt),
                    "unknown option --rat; did you mean --rate? (tool --help lists them)");
  const char* one_dash[] = {"tool", "-fas"};
  CHECK_THROWS_WITH(a.parse(2, one_dash),
                    "unknown option -fas; did you mean --fast? (tool --help lists them)");
  const char* far[] = {"tool", "--elsewhere"};
  CHECK_THROWS_WITH(a.parse(2, far), "unknown option --elsewhere (tool --help lists them)");
  const char* dashes[] = {"tool", "---"};
  CHECK_THROWS_AS(a.parse(2, dashes), UsageError);
  const char* missing[] = {"tool", "--out"};
  CHECK_THROWS_AS(a.parse(2, missing), UsageError);
  const char* not_number[] = {"tool", "--rate=fast"};
  REQUIRE(a.parse(2, not_number));
  CHECK_THROWS_AS(a.number("--rate"), UsageError);
  CHECK_THROWS_AS(a.required("--out"), UsageError);
}

TEST_CASE("a time is a week and its seconds, or what is wrong with it is reported") {
  const auto time_of = [](const std::string& text) {
    Arguments a("tool", "FILE", "Does a thing.");
    a.option("--from", "WEEK:SECONDS", "since");
    const std::string word = "--from=" + text;
    const char* argv[] = {"tool", word.c_str()};
    REQUIRE(a.parse(2, argv));
    return a.time("--from");
  };
  CHECK(time_of("2111:345600.5") == GpsTime::from_week_and_tow(2111, 345600.5));
  CHECK(time_of("2111:604800") == GpsTime::from_week_and_tow(2112, 0.0));
  for (const char* wrong : {"2111", "2111:", ":5", "2111:604801", "2111:-1", "-1:5", "10000:5",
                            "2111:nan", "2111:5x", "2111.5:5", ""}) {
    CAPTURE(wrong);
    CHECK_THROWS_WITH(time_of(wrong), Catch::Contains("--from needs WEEK:SECONDS_OF_WEEK") &&
                                          Catch::Contains("'" + std::string(wrong) + "'"));
  }
  CHECK_FALSE(sample().time("--rate").is_set());
}

TEST_CASE("a time is a week with seconds, or a date with hours, both of GPS time") {
  const auto time_of = [](const char* text) {
    Arguments a("tool", "", "Does a thing.");
    a.option("--from", "TIME", "from");
    const char* argv[] = {"tool", "--from", text};
    a.parse(3, argv);
    return a.time("--from");
  };
  const GpsTime noon = GpsTime::from_week_and_tow(2300, 0.0).plus_seconds(12 * 3600.0);
  CHECK(time_of("2300:43200") == noon);
  CHECK(time_of("2024-02-04T12:00:00") == noon);
  CHECK(time_of("2024-02-04 12:00") == noon);
  CHECK(time_of("2024-02-04T12:00:01.5") == noon.plus_seconds(1.5));
  for (const char* wrong :
       {"2024-02-04", "2024-02-30T00:00", "2024-02-04T24:00", "2024-02-04T12:60",
        "2024-02-04T12:00:60", "2024-02-04T12.00", "2024-02-04T12:00x", "2300"})
    CHECK_THROWS_AS(time_of(wrong), UsageError);
}
