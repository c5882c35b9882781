// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/capture/exports.hpp"

#include "libs/experiment/capture/capture_kind.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

CapturedMarkers Read(const std::string& name, const std::string& bytes) {
  const TestFolder folder;
  return ReadCapture(folder.Write(name, bytes));
}

std::string RefusalOfExport(const std::string& name, const std::string& bytes) {
  return MessageOf([&] { Read(name, bytes); });
}

/// Position of a marker in a frame, mm; NaN where it was not seen.
Eigen::Vector3d At_mm(const CapturedMarkers& captured, std::size_t frame, std::size_t marker) {
  const auto& position_m = captured.tracks.frames.at(frame).positions_m.at(marker);
  return position_m ? Eigen::Vector3d(1e3 * *position_m) : Eigen::Vector3d::Constant(NAN);
}

// A rigid body with its rotation as a quaternion stands between the markers, as Motive writes it.
const std::string kMotive =
    "Format Version,1.24,Take Name,bench,Capture Frame Rate,200.000000,Export Frame "
    "Rate,100.000000,"
    "Total Exported Frames,3,Rotation Type,Quaternion,Length Units,Centimeters,Coordinate Space,"
    "Global\n"
    ",\n"
    ",Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,"
    "Marker,Marker,Marker,Marker,Marker,Marker\n"
    ",Name,Clamp,Clamp,Clamp,Clamp,Clamp,Clamp,Clamp,Clamp,Arm:tip,Arm:tip,Arm:tip,Unlabeled 1007,"
    "Unlabeled 1007,Unlabeled 1007\n"
    ",ID,1,1,1,1,1,1,1,1,2,2,2,3,3,3\n"
    ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker Error,Position,"
    "Position,Position,Position,Position,Position\n"
    "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z,X,Y,Z\n"
    "0,0.000000,0,0,0,1,5,5,5,0.01,1.5,-2,3,7,8,9\n"
    "1,0.010000,0,0,0,1,5,5,5,0.01,1.6,-2,3,,,\n"
    "2,0.020000,0,0,0,1,5,5,5,0.01,1.7,-2,3,7,8,9\n";

TEST(CaptureExports, ReadsTheMarkersOfMotiveAndLeavesRigidBodiesOut) {
  const CapturedMarkers captured = Read("take.csv", kMotive);
  EXPECT_THAT(captured.tracks.names, ElementsAre("Arm:tip", "unlabelled_2"));
  EXPECT_EQ(captured.rate_Hz, 100.0);
  ASSERT_EQ(captured.tracks.frames.size(), 3u);
  EXPECT_EQ(captured.tracks.frames[2].t_s, 0.02);
  EXPECT_TRUE(At_mm(captured, 2, 0).isApprox(Eigen::Vector3d(17, -20, 30)));
  EXPECT_FALSE(captured.tracks.frames[1].positions_m[1].has_value());
  EXPECT_THAT(captured.notes, AllOf(Contains(HasSubstr("1 rigid bodies are left out")),
                                    Contains(HasSubstr("y axis points up"))));
}

TEST(CaptureExports, RefusesAMotiveFileWithoutMarkersOrUnit) {
  std::string bytes = kMotive;
  const std::string unit = "Length Units,Centimeters";
  bytes.replace(bytes.find(unit), unit.size(), "Length Units,Furlongs");
  EXPECT_THAT(RefusalOfExport("take.csv", bytes), HasSubstr("'Furlongs' is not known"));
  EXPECT_THAT(RefusalOfExport("take.csv", kMotive.substr(0, kMotive.find("Frame,Time"))),
              HasSubstr("without a line 'Frame,Time"));
  EXPECT_THAT(
      RefusalOfExport("take.csv",
                      "Format Version,1.23,Length Units,Meters\n\n,Type,Rigid Body,Rigid Body,"
                      "Rigid Body\n,Name,A,A,A\n,,Position,Position,Position\n"
                      "Frame,Time (Seconds),X,Y,Z\n0,0,1,2,3\n"),
      HasSubstr("without markers"));
  EXPECT_THAT(
      RefusalOfExport("take.csv",
                      "Format Version,1.23,Length Units,Meters,Coordinate Space,Local\n\n"
                      ",Type,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker\n,Name,A,A,A\n"
                      ",,Position,Position,Position\nFrame,Time (Seconds),X,Y,Z\n0,0,1,2,3\n"),
      HasSubstr("export in Global"));
}

// Nexus writes devices and trajectories one after the other, and velocities beside positions.
TEST(CaptureExports, ReadsTheTrajectoriesOfNexus) {
  const CapturedMarkers captured =
      Read("trial.csv",
           "Devices\n1000\n,,Force\nFrame,Sub Frame,Fx\n,,N\n1,0,0.1\n1,1,0.2\n\n"
           "Trajectories\n200\n,,Arm:tip,,,,,,Arm:base\n"
           "Frame,Sub Frame,X,Y,Z,X',Y',Z',X,Y,Z\n,,mm,mm,mm,mm/s,mm/s,mm/s,mm,mm,mm\n"
           "101,0,1,2,3,9,9,9,4,5,6\n102,0,1.5,2,3,9,9,9,,,\n\n");
  EXPECT_THAT(captured.tracks.names, ElementsAre("Arm:tip", "Arm:base"));
  EXPECT_EQ(captured.rate_Hz, 200.0);
  ASSERT_EQ(captured.tracks.frames.size(), 2u);
  EXPECT_EQ(captured.tracks.frames[0].t_s, 0.0);
  EXPECT_EQ(captured.tracks.frames[1].t_s, 0.005);
  EXPECT_TRUE(At_mm(captured, 1, 0).isApprox(Eigen::Vector3d(1.5, 2, 3)));
  EXPECT_TRUE(At_mm(captured, 0, 1).isApprox(Eigen::Vector3d(4, 5, 6)));
  EXPECT_FALSE(captured.tracks.frames[1].positions_m[1].has_value());
}

const std::string kQualisysHead =
    "NO_OF_FRAMES\t2\nNO_OF_CAMERAS\t8\nNO_OF_MARKERS\t2\nFREQUENCY\t50\nDESCRIPTION\t--\n"
    "TIME_STAMP\t2026-01-01, 00:00:00\nDATA_INCLUDED\t3D\nMARKER_NAMES\ttip\tbase\n";

TEST(CaptureExports, ReadsMarkersOfQualisysWithAndWithoutColumnTitles) {
  const std::string rows = "1\t2\t3\t4\t5\t6\n1.5\t2\t3\t0\t0\t0\n";
  const std::string titled =
      "Frame\tTime\ttip X\ttip Y\ttip Z\tbase X\tbase Y\tbase Z\n"
      "1\t0\t1\t2\t3\t4\t5\t6\n2\t0.02\t1.5\t2\t3\t0\t0\t0\n";
  for (const std::string& table : {rows, titled}) {
    const CapturedMarkers captured = Read("qtm.tsv", kQualisysHead + table);
    EXPECT_THAT(captured.tracks.names, ElementsAre("tip", "base"));
    ASSERT_EQ(captured.tracks.frames.size(), 2u);
    EXPECT_NEAR(captured.tracks.frames[1].t_s, 0.02, 1e-12);
    EXPECT_TRUE(At_mm(captured, 1, 0).isApprox(Eigen::Vector3d(1.5, 2, 3)));
    EXPECT_TRUE(At_mm(captured, 0, 1).isApprox(Eigen::Vector3d(4, 5, 6)));
    EXPECT_FALSE(captured.tracks.frames[1].positions_m[1].has_value()) << "0, 0, 0 is a gap";
  }
  EXPECT_THAT(RefusalOfExport("qtm.tsv", kQualisysHead + "1\t2\t3\t4\t5\n"),
              HasSubstr("5 numbers"));
}

TEST(CaptureExports, TakesTheOriginsOfRigidBodiesOfQualisysForMarkers) {
  std::string row = "10\t20\t30";
  for (int k = 0; k < 13; ++k) row += "\t0.5";
  const CapturedMarkers captured =
      Read("qtm6d.tsv",
           "NO_OF_FRAMES\t1\nNO_OF_BODIES\t1\nFREQUENCY\t50\nDATA_INCLUDED\t6D\nBODY_NAMES\thub\n" +
               row + "\n");
  EXPECT_THAT(captured.tracks.names, ElementsAre("hub"));
  EXPECT_TRUE(At_mm(captured, 0, 0).isApprox(Eigen::Vector3d(10, 20, 30)));
  EXPECT_THAT(captured.notes, ElementsAre(HasSubstr("6D")));
}

TEST(CaptureExports, ReadsTrc) {
  const CapturedMarkers captured =
      Read("walk.trc",
           "PathFileType\t4\t(X/Y/Z)\twalk.trc\n"
           "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n100\t100\t2\t2\tmm\n"
           "Frame#\tTime\ttip\t\t\tbase\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n"
           "1\t0.00\t1\t2\t3\t4\t5\t6\n2\t0.01\t1\t2\t3\tNaN\tNaN\tNaN\n");
  EXPECT_THAT(captured.tracks.names, ElementsAre("tip", "base"));
  EXPECT_TRUE(At_mm(captured, 0, 1).isApprox(Eigen::Vector3d(4, 5, 6)));
  EXPECT_FALSE(captured.tracks.frames[1].positions_m[1].has_value());
  EXPECT_EQ(captured.rate_Hz, 100.0);
}

TEST(CaptureExports, ReadsTrcWhoseNamesStandInNeighbouringColumns) {
  const std::string head =
      "PathFileType\t4\nDataRate\tNumMarkers\tUnits\n100\t2\tmm\nFrame#\tTime\t";
  const std::string rest = "\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n1\t0.0\t1\t2\t3\t4\t5\t6\n";
  const CapturedMarkers captured = Read("dense.trc", head + "tip\tbase" + rest);
  EXPECT_THAT(captured.tracks.names, ElementsAre("tip", "base"));
  EXPECT_TRUE(At_mm(captured, 0, 1).isApprox(Eigen::Vector3d(4, 5, 6)));
  EXPECT_THAT(RefusalOfExport("less.trc", head + "tip" + rest),
              HasSubstr("NumMarkers is 2, and 1 names stand here"));
}

TEST(CaptureExports, QualisysEventsAreNoFrames) {
  std::string head = kQualisysHead;
  head.insert(head.find("MARKER_NAMES"), "EVENT\tpress\t1\t0.02\nTRAJECTORY_TYPES\tMeasured\n");
  EXPECT_THAT(Read("qtm.tsv", head + "1\t2\t3\t4\t5\t6\n").tracks.names,
              ElementsAre("tip", "base"));
}

TEST(CaptureExports, QualisysNumbersMayHaveDecimalCommas) {
  const CapturedMarkers captured =
      Read("qtm.tsv", kQualisysHead + "1,5\t2\t3\t4\t5\t6\n2,5\t2\t3\t4\t5\t6\n");
  ASSERT_EQ(captured.tracks.frames.size(), 2u) << "the first line is no line of titles";
  EXPECT_TRUE(At_mm(captured, 0, 0).isApprox(Eigen::Vector3d(1.5, 2, 3)));
  EXPECT_EQ(Read("gap.tsv", kQualisysHead + "NaN\tNaN\tNaN\t4\t5\t6\n1\t2\t3\t4\t5\t6\n")
                .tracks.frames.size(),
            2u);
}

TEST(CaptureExports, AJumpToTheOriginIsAGap) {
  const std::string head =
      "PathFileType\t4\nDataRate\tNumMarkers\tUnits\n100\t2\tmm\nFrame#\tTime\ttip\t\t\tbase\n"
      "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n";
  // `tip` moves through the origin; `base` is there in two frames only.
  const CapturedMarkers captured =
      Read("zero.trc", head +
                           "1\t0.00\t-1\t0\t0\t40\t50\t60\n2\t0.01\t0\t0\t0\t0.000\t0.000\t-0.0\n"
                           "3\t0.02\t1\t0\t0\t0\t0\t0\n4\t0.03\t2\t0\t0\t40\t50\t60\n");
  for (std::size_t frame = 0; frame < 4; ++frame) {
    EXPECT_TRUE(captured.tracks.frames[frame].positions_m[0].has_value()) << frame;
    EXPECT_EQ(captured.tracks.frames[frame].positions_m[1].has_value(), frame == 0 || frame == 3);
  }
  EXPECT_THAT(captured.notes,
              ElementsAre("2 samples at exactly 0, 0, 0 are taken as not seen: base"));
  const CapturedMarkers always =
      Read("always.trc", head + "1\t0.00\t0\t0\t0\t40\t50\t60\n2\t0.01\t0\t0\t0\t40\t50\t60\n");
  EXPECT_TRUE(always.tracks.frames[1].positions_m[0].has_value());
  EXPECT_THAT(always.notes, ElementsAre(HasSubstr("always at 0, 0, 0: tip")));
}

/// As Windows programs write "Unicode" text.
std::string Utf16(const std::string& ascii) {
  std::string bytes = "\xFF\xFE";
  for (const char letter : ascii) bytes += {letter, '\0'};
  return bytes;
}

TEST(CaptureExports, EncodingsAndLineEndsOfTextDoNotMatter) {
  const std::string table = "t_s,marker,x_mm,y_mm,z_mm\n0,tip,1,2,3\n0.01,tip,4,5,6\n";
  std::string crlf, cr;
  for (const char letter : table) {
    crlf += letter == '\n' ? std::string("\r\n") : std::string(1, letter);
    cr += letter == '\n' ? '\r' : letter;
  }
  for (const std::string& bytes : {"\xEF\xBB\xBF" + table, Utf16(table), crlf, cr}) {
    const CapturedMarkers captured = Read("table.csv", bytes);
    ASSERT_EQ(captured.tracks.frames.size(), 2u);
    EXPECT_TRUE(At_mm(captured, 1, 0).isApprox(Eigen::Vector3d(4, 5, 6)));
  }
  EXPECT_THAT(Read("take.csv", Utf16(kMotive)).tracks.names,
              ElementsAre("Arm:tip", "unlabelled_2"));
}

TEST(CaptureExports, SayWhereANumberOrATimeIsWrong) {
  EXPECT_THAT(RefusalOfExport("qtm.tsv", kQualisysHead + "1\t2\tx\t4\t5\t6\n"),
              AllOf(HasSubstr("qtm.tsv:9:"), HasSubstr("'x' is not a finite number")));
  EXPECT_THAT(
      RefusalOfExport("a.trc",
                      "PathFileType\t4\nDataRate\tUnits\n100\tm\nFrame#\tTime\ta\n\t\tX1\tY1\tZ1\n"
                      "1\t0.1\t1\t2\t3\n2\t0.1\t1\t2\t3\n"),
      HasSubstr("a.trc:7:1: time must rise"));
  EXPECT_THAT(RefusalOfExport("qtm.tsv", kQualisysHead + "1\t2\t3\t4\t5\t99999\n"),
              HasSubstr("is this another unit?"));
}

TEST(CaptureExports, ToldApartByTheirFirstBytes) {
  const TestFolder folder;
  EXPECT_EQ(KindOfCapture(folder.Write("a.csv", kMotive)), CaptureKind::kMotive);
  EXPECT_EQ(KindOfCapture(folder.Write("b.tsv", kQualisysHead)), CaptureKind::kQualisys);
  EXPECT_EQ(KindOfCapture(folder.Write("c.csv", "t_s,marker\n")), CaptureKind::kTable);
  EXPECT_EQ(KindOfCapture(folder.Write("d.c3d", "")), CaptureKind::kC3d);
  EXPECT_EQ(KindOfCapture(folder.Write("e.bin", "hello")), CaptureKind::kNone);
  EXPECT_THAT(RefusalOfExport("e.bin", "hello"), HasSubstr("is no motion capture that is read"));
}

TEST(CaptureExports, PlainTablesMayHaveSemicolonsDecimalCommasAndNan) {
  const CapturedMarkers excel = Read("excel.csv",
                                     "t_s;marker;x_mm;y_mm;z_mm\n0,0;tip;1,5;2;3\n0,01;tip;1,25;2;"
                                     "3\n");
  EXPECT_TRUE(At_mm(excel, 0, 0).isApprox(Eigen::Vector3d(1.5, 2, 3)));
  EXPECT_EQ(excel.tracks.frames[1].t_s, 0.01);
  const CapturedMarkers nan =
      Read("nan.csv", "t_s,marker,x_mm,y_mm,z_mm\n0,tip,1,2,3\n0.01,tip,NaN,NaN,NaN\n");
  EXPECT_FALSE(nan.tracks.frames[1].positions_m[0].has_value());
  for (const std::string missing : {"", "nan", "-nan(ind)", "NULL", "#N/A", "1.#QNAN"}) {
    const CapturedMarkers gap =
        Read("gap.csv", "t_s,marker,x_mm,y_mm,z_mm\n0,tip,1,2,3\n0.01,tip," + missing + "," +
                            missing + "," + missing + "\n");
    EXPECT_FALSE(gap.tracks.frames[1].positions_m[0].has_value()) << missing;
  }
  const CapturedMarkers quoted =
      Read("quoted.csv",
           "\"t_s\",\"marker\",\"x_mm\",\"y_mm\",\"z_mm\"\n\"0,5\",\"tip\",\"1,25\",2,3\n");
  EXPECT_TRUE(At_mm(quoted, 0, 0).isApprox(Eigen::Vector3d(1.25, 2, 3)));
  EXPECT_THAT(RefusalOfExport("sep.csv", "sep=;\nt_s;marker;x_mm;y_mm;z_mm\n"),
              HasSubstr("'sep=;' is no header"));
  EXPECT_THAT(RefusalOfExport("mixed.csv", "t_s;marker;x_mm;y_mm;z_mm\n0,0;tip;1,5;2.000;3\n"),
              HasSubstr("'2.000'"));
}

}  // namespace
}  // namespace palpate::experiment
