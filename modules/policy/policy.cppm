/// What every kind of strategy has in common: a name, a summary, parameters that text can set, and a say in what it is
/// combined with.
export module aabb.policy;

export import :choice_parameter;
export import :configuration;
export import :exactness;
export import :integer_parameter;
export import :nearest_name;
export import :number_parameter;
export import :parameter_values;
export import :refusal;
export import :scene_outlook;
export import :strategy;
export import :strategy_choice;
export import :text_parameter;
export import :type_list;
