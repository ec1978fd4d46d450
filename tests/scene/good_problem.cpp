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
  "scene": {
    "gravity": [0, "-9.81 m/s^2", 0],
    "materials": {
      "steel": {"young": "210 GPa", "poisson": 0.3, "density": "7850 kg/m^3"},
      "alloy": {"young": 7e10, "poisson": "33 %", "density": "2.7 g/cm^3"}
    },
    "bodies": {
      "crank": {
        "type": "beam", "from": [0, 0, 0], "to": ["120 mm", 0, 0], "material": "steel",
        "section": {"type": "rectangle", "width": {"variable": "width"},
                    "height": {"variable": "width", "factor": 2}},
        "elements": 4, "frame": "tangent", "damping": {"mass": "2 1/s", "stiffness": "1e-5 s"}
      },
      "rod": {
        "type": "beam", "from": ["120 mm", 0, 0], "to": ["300 mm", 0, 0], "material": "alloy",
        "segments": [
          {"section": {"type": "tube", "outer_diameter": {"variable": "diameter"},
                       "thickness": "2 mm"}, "elements": 2, "length_fraction": 0.25},
          {"section": {"type": "circle", "diameter": "20 mm"}, "elements": 3,
           "length_fraction": 0.75}
        ],
        "frame": "chord", "reference": [0, 0, 1]
      },
      "slider": {"type": "point-mass", "at": ["300 mm", 0, 0], "mass": {"variable": "load"}},
      "wheel": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [0.1, 0.1, 0.2, 0, 0, 0]}
    },
    "joints": {
      "bearing": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                  "axis": [0, 0, 1],
                  "drive": {"type": "ramp-to-speed", "speed": "1500 rpm", "ramp": "50 ms"}},
      "hub": {"type": "fixed", "bodies": ["crank", "wheel"], "at": [0, 0, 0]},
      "pin": {"type": "revolute", "bodies": ["crank", "rod"], "at": ["120 mm", 0, 0]},
      "end": {"type": "revolute", "bodies": ["rod", "slider"], "at": ["300 mm", 0, 0]},
      "guide": {"type": "point-on-line", "bodies": ["ground", "slider"], "at": ["300 mm", 0, 0],
                "axis": [1, 0, 0]}
    }
  },
  "effects": {"spatial_motion": "auto", "geometric_stiffening": "on"},
  "simulation": {"end_time": "0.1 s", "step": "0.1 ms", "scheme": "generalized-alpha",
                 "spectral_radius": 0.9, "formulation": "index-3", "newton_tolerance": 1e-10,
                 "max_newton_iterations": 12},
  "variables": {
    "width": {"start": "20 mm", "lower": "4 mm", "upper": "6 cm"},
    "diameter": {"start": 0.03, "lower": 0.01, "upper": "60 mm"},
    "load": {"start": "0.3 kg", "lower": 0.1, "upper": "1 kg"}
  },
  "responses": {
    "weight": {"type": "mass", "bodies": ["crank", "rod"]},
    "stress": {"type": "stress", "body": "rod", "segment": 1, "over_time": "max"},
    "bow": {"type": "deflection", "body": "rod", "at": 0.5, "direction": "z",
            "over_time": "max-abs"},
    "place": {"type": "position", "body": "rod", "at": 1, "direction": "x", "over_time": "final"},
    "impulse": {"type": "drive-torque", "joint": "bearing", "over_time": "integral"}
  },
  "objective": {"minimize": "weight"},
  "constraints": {
    "strength": {"response": "stress", "upper": "200 MPa"},
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

}  // namespace pleuel::test
