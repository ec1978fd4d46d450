#include "tests/scene/good_problem.hpp"

#include "core/base/error.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test {

std::string good_text() {
  return R"({
  "$schema": "problem.schema.json",
  "name": "good",
  "description": "a bit of everything",
  "scene": {"gravity": [0, "-9.81 m/s^2", 0],
    "materials": {
      "steel": {"young": "210 GPa", "poisson": 0.3, "density": "7850 kg/m^3"},
      "alloy": {"young": 7e10, "poisson": "33 %", "density": "2.7 g/cm^3"}
    },
    "bodies": {
      "crank": {"type": "beam", "from": [0, 0, 0], "to": ["120 mm", 0, 0], "material": "steel",
        "section": {"type": "rectangle", "width": {"variable": "width"},
                    "height": {"variable": "width", "factor": 2}},
        "elements": 4, "frame": "tangent", "damping": {"mass": "2 1/s", "stiffness": "1e-5 s"}},
      "rod": {"type": "beam", "from": ["120 mm", 0, 0], "to": ["300 mm", 0, 0], "material": "alloy",
        "segments": [
          {"section": {"type": "tube", "outer_diameter": {"variable": "diameter"},
                       "thickness": "2 mm"}, "elements": 2, "length_fraction": 0.25},
          {"section": {"type": "circle", "diameter": "20 mm"}, "elements": 3, "length_fraction": 0.75}],
        "frame": "chord", "reference": [0, 0, 1]},
      "slider": {"type": "point-mass", "at": ["300 mm", 0, 0], "mass": {"variable": "load"}},
      "wheel": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [0.1, 0.1, 0.2, 0, 0, 0]}
    },
    "joints": {
      "bearing": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0], "axis": [0, 0, 1],
                  "drive": {"type": "ramp-to-speed", "speed": "1500 rpm", "ramp": "50 ms"}},
      "hub": {"type": "fixed", "bodies": ["crank", "wheel"], "at": [0, 0, 0]},
      "pin": {"type": "revolute", "bodies": ["crank", "rod"], "at": ["120 mm", 0, 0]},
      "end": {"type": "revolute", "bodies": ["rod", "slider"], "at": ["300 mm", 0, 0]},
      "guide": {"type": "point-on-line", "bodies": ["ground", "slider"], "at": ["300 mm", 0, 0], "axis": [1, 0, 0]}
    }
  },
  "effects": {"spatial_motion": "auto", "geometric_stiffening": "on"},
  "simulation": {"end_time": "0.1 s", "step": "0.1 ms", "scheme": "generalized-alpha",
                 "spectral_radius": 0.9, "formulation": "index-3", "newton_tolerance": 1e-10,
                 "max_newton_iterations": 12},
  "variables": {"width": {"start": "20 mm", "lower": "4 mm", "upper": "6 cm"},
    "diameter": {"start": 0.03, "lower": 0.01, "upper": "60 mm"},
    "load": {"start": "0.3 kg", "lower": 0.1, "upper": "1 kg"}},
  "responses": {
    "weight": {"type": "mass", "bodies": ["crank", "rod"]},
    "stress": {"type": "stress", "body": "rod", "segment": 1, "over_time": "max"},
    "bow": {"type": "deflection", "body": "rod", "at": 0.5, "direction": "z", "over_time": "max-abs"},
    "place": {"type": "position", "body": "rod", "at": 1, "direction": "x", "over_time": "final"},
    "impulse": {"type": "drive-torque", "joint": "bearing", "over_time": "integral"}
  },
  "objective": {"minimize": "weight"},
  "constraints": {"strength": {"response": "stress", "upper": "200 MPa"},
    "stiffness": {"response": "bow", "upper": "0.2 mm"},
    "effort": {"response": "impulse", "lower": "-1 N m s", "upper": "1 N m s"},
    "slender": {"linear": {"diameter": 1, "width": -2}, "upper": "1 mm"}
  },
  "sensitivity": {"method": "central-difference", "difference_step": 1e-4,
                  "invariant_derivatives": "central", "invariant_step": 1e-5,
                  "memory": "512 MB"},
  "optimizer": {"backend": "ipopt", "tolerance": 1e-5, "max_iterations": 50, "starts": 3},
  "pareto": {"constraint": "stiffness", "from": "0.1 mm", "to": "0.4 mm", "points": 5},
  "accuracy": {"steps": ["1e-4 s", 5e-5], "elements": [2, 4], "target": 1e-2}
})";
}

Json good_json() {
  return Json::parse(good_text());
}

ProblemFile read(const Json& document) {
  return read_problem_text(document.dump(), "bad.json").complete();
}

std::string complaint(const Json& document) {
  return complaint_about_text(document.dump());
}

std::string complaint_about_text(const std::string& text) {
  return thrown<InputError>([&] { read_problem_text(text, "bad.json").complete(); });
}

Json edited(const std::string& pointer, const std::string& value) {
  return edited(good_json(), pointer, value);
}

Json edited(Json document, const std::string& pointer, const std::string& value) {
  const Json::json_pointer place(pointer);
  if (value == "remove") {
    Json& parent = document.at(place.parent_pointer());
    if (parent.is_array()) {
      parent.erase(std::stoul(place.back()));
    } else {
      parent.erase(place.back());
    }
  } else {
    document[place] = Json::parse(value);
  }
  return document;
}

Json good_mechanism() {
  return Json::parse(R"({
  "scene": {
    "materials": {
      "steel": {"young": "210 GPa", "poisson": 0.3, "density": 7850, "strength": "250 MPa"},
      "glass": {"young": "70 GPa", "poisson": 0.2, "density": 2500}
    },
    "bodies": {
      "arm": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
        "section": {"type": "circle", "diameter": "20 mm"}, "elements": 8, "frame": "tangent",
        "reduction": {"modes": 4}, "damping": {"modal": "2 %"}},
      "rod": {"type": "beam", "from": [1, 0, 0], "to": [2, 0, 0], "material": "glass",
        "segments": [{"section": {"type": "circle", "diameter": 0.02}, "elements": 2},
                     {"section": {"type": "circle", "diameter": 0.01}, "elements": 2}],
        "frame": "mean-axis", "reduction": {"frequency": "2 kHz"}, "damping": {"mass": 1},
        "velocity": ["1 m/s", 0, 0], "angular_velocity": [0, 0, "30 rpm"]},
      "tail": {"type": "beam", "from": [1, 2, 0], "to": [2, 2, 0], "material": "steel",
        "section": {"type": "circle", "diameter": 0.02}, "elements": 2, "frame": "tangent-end"
      },
      "strut": {"type": "beam", "from": [0, 1, 0], "to": [1, 1, 0], "material": "steel",
        "section": {"type": "circle", "diameter": 0.02}, "elements": 1, "rigid": true
      },
      "block": {"type": "rigid", "at": [3, 0, 0], "mass": 2, "inertia": [0.1, 0.1, 0.2, 0, 0, 0],
        "velocity": [0, "-2 m/s", 0], "angular_velocity": ["90 deg/s", 0, 0]},
      "ball": {"type": "point-mass", "at": [4, 0, 0], "mass": 1, "velocity": [{"variable": "speed"}, 0, 0]}
    },
    "joints": {
      "shoulder": {"type": "cylindrical", "bodies": ["ground", "arm"], "at": [0, 0, 0], "axis": [0, 0, 2],
        "drive": {"type": "polynomial", "coordinate": "angle", "coefficients": [0, "60 rpm", "180 deg/s^2"]}},
      "elbow": {"type": "universal", "bodies": ["arm", "rod"], "at": [1, 0, 0], "axis": [0, 0, 1],
        "second_axis": [0, 5, 0],
        "drive": {"type": "harmonic", "amplitude": "10 deg", "frequency": "600 rpm",
                  "phase": "90 deg", "offset": {"variable": "offset"}}},
      "wrist": {"type": "spherical", "bodies": ["rod", "block"], "at": [1.3, 0, 0]},
      "pivot": {"type": "spherical", "bodies": ["ground", "strut"], "at": [0, 5, 1]},
      "floor": {"type": "planar", "bodies": ["ground", "block"], "at": [3, 0, 0],
                "axis": [0, 0, 1], "drive": {"type": "constant", "value": 0}},
      "tie": {"type": "distance", "bodies": ["rod", "strut"], "at": [1.25, 0, 0], "to": [1, 1, 0],
              "drive": {"type": "table", "times": [0, "50 ms", 0.1], "values": [0, "1 mm", 0]}},
      "rail": {"type": "prismatic", "bodies": ["strut", "tail"], "at": [1, 2, 0], "axis": [1, 0, 0]},
      "line": {"type": "point-on-line", "bodies": ["ground", "ball"], "at": [4, 0, 0], "axis": [0, 1, 0],
               "drive": {"type": "ramp-to-speed", "speed": "20 mm/s", "ramp": "50 ms",
                         "coordinate": "displacement"}}},
    "loads": {
      "push": {"type": "force", "body": "arm", "at": [0.37, 0, 0], "direction": [0, 3, 4],
               "value": "2 kN", "follows": true},
      "pull": {"type": "force", "body": "ball", "at": [4, 0, 0], "direction": [1, 0, 0],
               "value": {"variable": "force", "factor": 2}},
      "gust": {"type": "force", "body": "block", "at": [3, 7, 0], "direction": [0, 1, 0],
               "value": {"type": "polynomial", "coefficients": ["1 N", "2 N/s"]}},
      "twist": {"type": "torque", "body": "tail", "at": [1.5, 2, 0], "direction": [-2, 0, 0],
                "value": {"type": "harmonic", "amplitude": "3 N m", "frequency": 10}},
      "strap": {"type": "spring", "bodies": ["ground", "ball"], "at": [[5, 0, 0], [4, 0, 0]],
                "stiffness": "2 N/mm", "damping": "3 N s/m", "free_length": "900 mm"},
      "cord": {"type": "spring", "bodies": ["arm", "block"], "at": [[0.123, 0, 0], [3, 1, 0]],
               "stiffness": 0, "damping": 3},
      "stopper": {"type": "joint", "joint": "shoulder", "coordinate": "displacement",
                  "stiffness": "2 kN/m", "damping": 4, "rest": "5 mm",
                  "motor": {"type": "table", "times": [0, 1], "values": ["1 N", 2]}},
      "hinge": {"type": "joint", "joint": "elbow", "damping": "0.1 N m s/rad"},
      "bush": {"type": "joint", "joint": "rail", "motor": "7 N"}
    }
  },
  "effects": {"spatial_motion": "on", "geometric_stiffening": "off", "rotary_inertia": "off",
              "elasticity": "on", "axial_elasticity": "off", "torsional_elasticity": "on", "tolerance": 1e-3},
  "simulation": {"end_time": 0.1, "step": 1e-3, "initial_state": "quasi-static"},
  "variables": {"speed": {"start": "1 m/s", "lower": 0, "upper": 2},
    "offset": {"start": 0, "lower": "-5 deg", "upper": "5 deg"},
    "force": {"start": "10 N", "lower": 0, "upper": "20 N"}
  },
  "responses": {
    "speed": {"type": "velocity", "body": "rod", "at": 0.5, "direction": "magnitude", "over_time": "max"},
    "jolt": {"type": "acceleration", "body": "block", "direction": "y", "over_time": "rms",
             "from": "20 ms", "to": 0.1},
    "energy": {"type": "drive-power", "joint": "shoulder", "over_time": "integral"},
    "effort": {"type": "drive-torque", "joint": "elbow", "over_time": "max-abs", "to": 0.05},
    "thrust": {"type": "drive-force", "joint": "tie", "over_time": "mean"},
    "bearing": {"type": "reaction-force", "joint": "pivot", "direction": "magnitude",
                "over_time": "max", "from": 0.05},
    "clamp": {"type": "reaction-moment", "joint": "rail", "direction": "z", "over_time": "min"},
    "tone": {"type": "frequency", "body": "arm", "mode": 2},
    "mechanism_tone": {"type": "frequency"},
    "stability": {"type": "buckling", "body": "rod", "over_time": "max"},
    "normal": {"type": "stress", "body": "arm", "part": "normal", "at": 0.25, "over_time": "min"},
    "axial": {"type": "stress", "body": "arm", "part": "axial", "over_time": "max"},
    "bending": {"type": "stress", "body": "arm", "part": "bending", "over_time": "max"},
    "shear": {"type": "stress", "body": "rod", "part": "shear", "segment": 1, "over_time": "max"},
    "use": {"type": "stress", "body": "arm", "part": "utilization", "over_time": "max"},
    "strain": {"type": "stress", "body": "arm", "part": "von-mises", "over_time": "max"},
    "motion": {"type": "kinetic-energy", "over_time": "max"},
    "swing": {"type": "kinetic-energy", "body": "block", "over_time": "integral"},
    "spring": {"type": "elastic-energy", "body": "arm", "over_time": "mean", "from": 0.05},
    "missing": {"type": "energy-balance", "to": 0.05},
    "comfort": {"type": "jerk", "body": "block", "direction": "y", "over_time": "rms"},
    "surge": {"type": "joint-acceleration", "joint": "elbow", "over_time": "max"},
    "swerve": {"type": "angular-jerk", "body": "rod", "direction": [0, 0, 2], "over_time": "max-abs"},
    "drift": {"type": "constraint-drift", "over_time": "max-abs"},
    "speed_drift": {"type": "constraint-drift", "level": "velocity", "over_time": "rms"}
  },
  "objective": {"minimize": "energy"},
  "constraints": {
    "resonance": {"response": "tone", "lower": "600 rpm"},
    "strength": {"response": "use", "upper": "80 %"},
    "buckling": {"response": "stability", "upper": 0.5},
    "power": {"response": "effort", "upper": "10 N m"}
  }
})");
}

}  // namespace pleuel::test
