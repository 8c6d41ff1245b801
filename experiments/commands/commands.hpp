#pragma once

namespace CLI {
class App;
}

/// The commands of the program, one a file. Each adds itself to the command line and sets `status` when it has run:
/// 0, or 1 when a check failed. Bad input is thrown as aabb::input_error, which ends the program with status 2.
namespace aabblab {

void add_atlas(CLI::App& program, int& status);
void add_calibrate(CLI::App& program, int& status);
void add_classify(CLI::App& program, int& status);
void add_collide(CLI::App& program, int& status);
void add_compare(CLI::App& program, int& status);
void add_contacts(CLI::App& program, int& status);
void add_errors(CLI::App& program, int& status);
void add_explain(CLI::App& program, int& status);
void add_recommend(CLI::App& program, int& status);
void add_list(CLI::App& program, int& status);
void add_order(CLI::App& program, int& status);
void add_pairs(CLI::App& program, int& status);
void add_reproduce(CLI::App& program, int& status);
void add_run(CLI::App& program, int& status);
void add_scene(CLI::App& program, int& status);
void add_validate(CLI::App& program, int& status);
void add_validate_extreme(CLI::App& validate, int& status);
void add_validate_stiff(CLI::App& validate, int& status);

}  // namespace aabblab
