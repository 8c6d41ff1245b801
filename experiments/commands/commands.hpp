#pragma once

/// The commands of the program, one a file. Each adds itself to the command line and sets `status` when it has run:
/// 0, or 1 when a check failed. Bad input is thrown as aabb::input_error, which ends the program with status 2.
namespace aabblab {

class command_parser;

void add_atlas(const command_parser& program, int& status);
void add_calibrate(const command_parser& program, int& status);
void add_classify(const command_parser& program, int& status);
void add_collide(const command_parser& program, int& status);
void add_compare(const command_parser& program, int& status);
void add_contacts(const command_parser& program, int& status);
void add_errors(const command_parser& program, int& status);
void add_explain(const command_parser& program, int& status);
void add_recommend(const command_parser& program, int& status);
void add_list(const command_parser& program, int& status);
void add_order(const command_parser& program, int& status);
void add_pairs(const command_parser& program, int& status);
void add_reproduce(const command_parser& program, int& status);
void add_run(const command_parser& program, int& status);
void add_scene(const command_parser& program, int& status);
void add_validate(const command_parser& program, int& status);
void add_validate_extreme(const command_parser& validate, int& status);
void add_validate_stiff(const command_parser& validate, int& status);

}  // namespace aabblab
