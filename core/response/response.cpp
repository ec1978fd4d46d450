#include "core/response/response.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/response/motion_signals.hpp"
#include "core/response/projected_signal.hpp"
#include "core/response/stress_signal.hpp"
#include "core/scene/response_quantity.hpp"

namespace pleuel {

namespace {

void set_mass(const ResponseSettings& settings, const Model& model, Response& response) {
  response.constant_x = Eigen::VectorXd::Zero(model.mechanism.system->variables());
  for (const BodyModel& body : model.bodies) {
    const bool is_counted = settings.bodies.empty() ||
                            std::find(settings.bodies.begin(), settings.bodies.end(), body.name) !=
                                settings.bodies.end();
    if (!is_counted) continue;
    response.constant += body.mass;
    response.constant_x += body.mass_x;
  }
}

}  // namespace

std::vector<Response> make_responses(const std::vector<ResponseSettings>& settings,
                                     const Model& model) {
  std::vector<Response> responses;
  for (const ResponseSettings& setting : settings) {
    Response response;
    response.name = setting.name;
    response.unit = quantity_of(setting).unit;
    response.over_time = setting.over_time;
    const auto set_body_signal = [&](const auto& make) {
      const BodyModel& body = model.body(setting.bodies.front());
      if (!body.basis) {
        response.signal = make(body);
      } else {
        response.signal = std::make_unique<ProjectedSignal>(make(*body.nodal), body.map,
                                                            model.mechanism.system->variables());
      }
    };
    switch (setting.type) {
      case ResponseType::mass:
        set_mass(setting, model, response);
        break;
      case ResponseType::stress:
        set_body_signal([&](const BodyModel& body) {
          return make_stress_signal(body, model.gravity, setting.segment);
        });
        break;
      case ResponseType::deflection:
        set_body_signal([&](const BodyModel& body) {
          return make_deflection_signal(body, setting.at, setting.direction);
        });
        break;
      case ResponseType::position:
        set_body_signal([&](const BodyModel& body) {
          return make_position_signal(body, setting.at, setting.direction);
        });
        break;
      case ResponseType::drive_torque:
        response.signal = make_drive_torque_signal(model.joint(setting.joint));
        break;
      default:
        throw InputError(fmt::format("the response \"{}\" cannot be computed", setting.name));
    }
    responses.push_back(std::move(response));
  }
  return responses;
}

Eigen::MatrixXd observe(Signal& signal, const Trajectory& trajectory) {
  Eigen::MatrixXd history(signal.channels(), trajectory.steps() + 1);
  State state;
  for (int step = 0; step <= trajectory.steps(); ++step) {
    trajectory.load(step, state);
    signal.observe(state, history.col(step));
  }
  return history;
}

Eigen::VectorXd start_design(const ProblemFile& problem) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(problem.variables.size()));
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    x(static_cast<Eigen::Index>(i)) = problem.variables[i].start;
  }
  return x;
}

std::unique_ptr<Analysis> analyze(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd start = start_design(problem);
  const Design<double> design(x.begin(), x.end()), start_values(start.begin(), start.end());
  auto analysis = std::make_unique<Analysis>();
  analysis->model = build_model(problem.scene, problem.effects, start_values, design);
  const SimulationSettings& settings = problem.simulation;
  analysis->trajectory = simulate(analysis->model.mechanism,
                                  {settings.end_time, settings.step, settings.spectral_radius,
                                   settings.newton_tolerance, settings.max_newton_iterations});
  analysis->responses = make_responses(problem.responses, analysis->model);
  for (Response& response : analysis->responses) {
    Reduction reduction;
    Eigen::MatrixXd history;
    if (response.signal) {
      history = observe(*response.signal, analysis->trajectory);
      reduction = reduce(response.over_time, analysis->trajectory.time, history);
    } else {
      reduction.value = response.constant;
    }
    analysis->reductions.push_back(std::move(reduction));
    analysis->histories.push_back(std::move(history));
  }
  return analysis;
}

}  // namespace pleuel
