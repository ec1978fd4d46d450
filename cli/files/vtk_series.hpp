#pragma once

#include "cli/files/output_file.hpp"
#include "core/response/analysis.hpp"

namespace pleuel {

/// The motion of a simulation for ParaView: NAME.pvd with its instants, and for each of them
/// NAME-0000.vtu (VTK XML): beams as surfaces with their true sections and the von Mises stress
/// along them [Pa], other bodies as points; `body` counts the bodies of the scene from 0.
/// @param most  instants, besides those of peaks
/// @returns     how many instants were written
int write_vtk_series(const std::filesystem::path& folder, const std::string& name,
                     const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis,
                     int most, std::vector<std::string>& unwritten);

}  // namespace pleuel
