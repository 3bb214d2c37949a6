#include "input/base/byte_stream.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/temp_folder.hpp"

namespace limn {
namespace {

std::string read_all(ByteSource& bytes) {
  std::string all;
  std::array<char, 7> block{};
  for (;;) {
    const auto count = bytes.read(block);
    EXPECT_TRUE(count);
    if (!count || *count == 0) return all;
    all.append(block.data(), *count);
  }
}

TEST(ByteStream, ReadsAFile) {
  const test::TempFolder folder;
  auto bytes = open_bytes(folder.write("trace", std::string_view("one\0two three", 13)).string());
  ASSERT_TRUE(bytes);
  EXPECT_EQ(read_all(**bytes), std::string_view("one\0two three", 13));
}

TEST(ByteStream, ReadsMemory) {
  EXPECT_EQ(read_all(*memory_bytes("some text of more than one block")),
            "some text of more than one block");
  EXPECT_EQ(read_all(*memory_bytes("")), "");
}

TEST(ByteStream, SaysWhyAFileCannotBeOpened) {
  const test::TempFolder folder;
  const auto absent = open_bytes((folder.path() / "absent").string());
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::kIo);
  EXPECT_EQ(absent.error().what, "cannot be opened: No such file or directory");
  EXPECT_FALSE(absent.error().remedy.empty());
}

TEST(ByteStream, RefusesAFolderAtOnce) {
  const test::TempFolder folder;
  const auto opened = open_bytes(folder.path().string());
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().what, "cannot be read: Is a directory");
}

TEST(ByteStream, StringSinkKeepsWhatItIsGiven) {
  StringSink sink;
  ASSERT_TRUE(sink.write("one "));
  ASSERT_TRUE(sink.write("two"));
  EXPECT_EQ(sink.text(), "one two");
}

}  // namespace
}  // namespace limn
