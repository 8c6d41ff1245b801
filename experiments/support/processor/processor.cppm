/// Where this process runs.
export module aabblab.processor;

export namespace aabblab {

/// Keeps this thread on one processor, so that its caches stay warm: of those that it may run on the one that has been
/// the least busy for the last moment. Where the system does not allow it, all stays as it is.
void stay_on_idlest_processor();

}  // namespace aabblab
