/// The common parts of all strategies: a name, a summary, parameters set by text, and rejection of combinations.
export module aabb.policy;

export import aabb.base;

export import :configuration;
export import :nearest_name;
export import :omission;
export import :parameters;
export import :strategy;
export import :strategy_choice;
