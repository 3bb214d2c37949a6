#include "tests/conventions/layering.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limn::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Layering, HoldsInEveryFile) {
  const auto files = source_files(LIMN_SOURCE_DIR);
  ASSERT_GT(files.size(), 20U);
  for (const auto& file : files) EXPECT_THAT(layering_violations(file), IsEmpty());
  EXPECT_THAT(heavy_header_violations(files), IsEmpty());
}

std::vector<std::string> violations(const std::string& path, const std::string& text) {
  return layering_violations({path, text});
}

TEST(Layering, DriversAndModelerDoNotSeeEachOther) {
  EXPECT_THAT(violations("drivers/hid/a.cpp", "#include \"modeler/bspline/knot_vector.hpp\"\n"),
              ElementsAre(HasSubstr("may not see modeler/bspline/knot_vector.hpp")));
  EXPECT_THAT(violations("modeler/fit/a.cpp", "#include \"drivers/hid/usages.hpp\"\n"),
              ElementsAre(HasSubstr("may not see drivers/hid/usages.hpp")));
  EXPECT_THAT(violations("modeler/fit/a.cpp", "#include \"input/stroke/stroke.hpp\"\n"), IsEmpty());
  EXPECT_THAT(violations("modeler/app/a.cpp",
                         "#include \"drivers/hid/a.hpp\"\n#include \"modeler/fit/a.hpp\"\n"),
              IsEmpty());
}

TEST(Layering, TheVocabularyNeedsNothing) {
  EXPECT_THAT(violations("input/base/a.hpp", "#include \"input/sample/report.hpp\"\n"),
              ElementsAre(HasSubstr("may not see")));
  EXPECT_THAT(violations("input/sample/a.cpp", "#include <Eigen/Core>\n"),
              ElementsAre(HasSubstr("may not use <Eigen/Core>")));
}

TEST(Layering, EarlierPartsOfTheModelerDoNotSeeLaterOnes) {
  EXPECT_THAT(violations("modeler/bspline/a.hpp", "#include \"modeler/fit/fit_curve.hpp\"\n"),
              ElementsAre(HasSubstr("may not see")));
  EXPECT_THAT(violations("modeler/view/a.cpp", "#include \"modeler/exchange/a.hpp\"\n"),
              ElementsAre(HasSubstr("may not see")));
  EXPECT_THAT(violations("modeler/view/a.cpp", "#include \"modeler/sketch/sketch.hpp\"\n"),
              IsEmpty());
}

TEST(Layering, FirmwareStandsAlone) {
  EXPECT_THAT(violations("firmware_sim/devices/a.cpp", "#include \"input/base/error.hpp\"\n"),
              ElementsAre(HasSubstr("may not see")));
  EXPECT_THAT(violations("firmware_sim/devices/a.cpp", "#include \"firmware_sim/usb/hid.hpp\"\n"),
              IsEmpty());
}

TEST(Layering, BackendsStayInSourceFilesOfTheirFolder) {
  EXPECT_THAT(violations("modeler/view/a.cpp", "#include <cairo.h>\n"), IsEmpty());
  EXPECT_THAT(violations("modeler/view/a.hpp", "#include <cairo.h>\n"),
              ElementsAre(HasSubstr("may not use <cairo.h>")));
  EXPECT_THAT(violations("modeler/fit/a.cpp", "#include <gp_Pnt.hxx>\n"),
              ElementsAre(HasSubstr("may not use <gp_Pnt.hxx>")));
  EXPECT_THAT(violations("input/trace/a.cpp", "#include <unistd.h>\n"),
              ElementsAre(HasSubstr("may not use <unistd.h>")));
}

TEST(Layering, IncludesAreWrittenFromTheRoot) {
  EXPECT_THAT(violations("input/base/a.cpp", "#include \"error.hpp\"\n"),
              ElementsAre(HasSubstr("may not see error.hpp")));
  EXPECT_THAT(violations("input/base/a.cpp", "#include \"input/base/error.hpp\"\n"), IsEmpty());
}

TEST(Layering, ANewFolderMustBeGivenItsLayer) {
  EXPECT_THAT(violations("modeler/extras/a.cpp", ""), ElementsAre(HasSubstr("no layer knows")));
}

TEST(Layering, HeavyHeadersAreIncludedOnceAFolder) {
  const SourceFile first{"modeler/exchange/a.cpp", "#include <gp_Pnt.hxx>\n"};
  const SourceFile second{"modeler/exchange/b.cpp", "#include <gp_Dir.hxx>\n"};
  const SourceFile elsewhere{"tests/bench/c.cpp", "#include <gp_Dir.hxx>\n"};
  EXPECT_THAT(heavy_header_violations({first, elsewhere}), IsEmpty());
  EXPECT_THAT(heavy_header_violations({first, second}),
              ElementsAre(HasSubstr("modeler/exchange/b.cpp: Open CASCADE")));
}

}  // namespace
}  // namespace limn::test
