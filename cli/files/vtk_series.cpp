#include "cli/files/vtk_series.hpp"

#include <variant>

#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "picture/section_outline.hpp"

namespace pleuel {

namespace {

constexpr int vertex_cell = 1, polygon_cell = 7;  // types of VTK

/// One instant: points, cells, and what is known of them, as text.
class Grid {
 public:
  void add(const SweptSurface& surface, int body) {
    const int first = points_;
    for (Eigen::Index i = 0; i < surface.points.cols(); ++i) {
      add_point(surface.points.col(i), surface.stress.size() > 0 ? surface.stress(i) : 0.0);
    }
    for (const std::vector<int>& face : surface.faces) {
      for (const int point : face) connectivity_ += fmt::format("{} ", first + point);
      end_cell(int_size(face), polygon_cell, body);
    }
  }

  /// Places of a body that has no surface.
  void add(const BodyTrack& motion, Eigen::Index instant, int body) {
    for (Eigen::Index k = 0; 3 * k < motion.positions.rows(); ++k) {
      connectivity_ += fmt::format("{} ", points_);
      add_point(motion.positions.block<3, 1>(3 * k, instant), 0.0);
      end_cell(1, vertex_cell, body);
    }
  }

  std::string text() const {
    return fmt::format(R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
<UnstructuredGrid><Piece NumberOfPoints="{}" NumberOfCells="{}">
<PointData Scalars="stress">
<DataArray type="Float64" Name="stress" format="ascii">
{}
</DataArray>
</PointData>
<CellData>
<DataArray type="Int32" Name="body" format="ascii">
{}
</DataArray>
</CellData>
<Points>
<DataArray type="Float64" NumberOfComponents="3" format="ascii">
{}</DataArray>
</Points>
<Cells>
<DataArray type="Int32" Name="connectivity" format="ascii">
{}
</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">
{}
</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">
{}
</DataArray>
</Cells>
</Piece></UnstructuredGrid>
</VTKFile>
)",
                       points_, cells_, stress_, bodies_, coordinates_, connectivity_, offsets_,
                       types_);
  }

 private:
  void add_point(const Eigen::Vector3d& point, double stress) {
    coordinates_ += fmt::format("{:.9g} {:.9g} {:.9g}\n", point.x(), point.y(), point.z());
    stress_ += fmt::format("{:.6g} ", stress);
    ++points_;
  }

  void end_cell(int points, int type, int body) {
    end_ += points;
    offsets_ += fmt::format("{} ", end_);
    types_ += fmt::format("{} ", type);
    bodies_ += fmt::format("{} ", body);
    ++cells_;
  }

  int points_ = 0, cells_ = 0, end_ = 0;
  std::string coordinates_, stress_, connectivity_, offsets_, types_, bodies_;
};

Grid grid_at(const ProblemFile& problem, const Design<double>& design, const Motion& motion,
             Eigen::Index instant) {
  Grid grid;
  for (std::size_t i = 0; i < problem.scene.bodies.size(); ++i) {
    const BodyTrack& body = motion.bodies[i];
    const int number = static_cast<int>(i);
    if (const auto* beam = std::get_if<BeamBody>(&problem.scene.bodies[i].shape)) {
      grid.add(swept_beam(*beam, design, body, instant), number);
    } else {
      grid.add(body, instant, number);
    }
  }
  return grid;
}

}  // namespace

int write_vtk_series(const std::filesystem::path& folder, const std::string& name,
                     const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis,
                     int most, std::vector<std::string>& unwritten) {
  const Motion motion = sample_motion(problem.scene, analysis, frames_of_motion(analysis, most));
  const Design<double> design(x.begin(), x.end());
  std::string entries;
  for (Eigen::Index i = 0; i < motion.time.size(); ++i) {
    const std::string file = fmt::format("{}-{:04}.vtu", name, i);
    write_file({folder / file, &unwritten}, grid_at(problem, design, motion, i).text());
    entries += fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>\n", motion.time(i), file);
  }
  write_file({folder / (name + ".pvd"), &unwritten},
             fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" "
                         "version=\"0.1\">\n<Collection>\n{}</Collection>\n</VTKFile>\n",
                         entries));
  return int_size(motion.time);
}

}  // namespace pleuel
