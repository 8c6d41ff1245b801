module aabblab.configs;

import aabb.base;
import aabb.validation;

namespace aabblab {

std::unique_ptr<aabb::triangle_test> triangle_test_named(const aabb::strategy_choice& choice) {
    std::vector<std::string> names = aabb::strategy_names(aabb::strategy_kind::triangle);
    if (std::ranges::find(names, choice.name) != names.end()) return aabb::make_triangle_test(choice);
    for (const aabb::library_test_info& test : aabb::library_tests()) {
        if (test.name == choice.name) return aabb::make_library_test(choice);
        names.push_back(test.name);
    }
    throw aabb::input_error(aabb::unknown_name("triangle", choice.name, names));
}

std::vector<std::string> constructing_tests() {
    std::vector<std::string> names = aabb::strategy_names(aabb::strategy_kind::triangle);
    for (const aabb::library_test_info& test : aabb::library_tests()) names.push_back(test.name);
    std::erase_if(names, [](const std::string& name) { return !triangle_test_named({name, {}})->constructs(); });
    return names;
}

}  // namespace aabblab
