/// What every kind of strategy has in common: a name, a summary, parameters that text sets, a say in what it goes with.
export module aabb.policy;

export import aabb.base;

export import :configuration;
export import :nearest_name;
export import :omission;
export import :parameters;
export import :strategy;
export import :strategy_choice;
