module;
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

module aabblab.stepping;

import :first_order;
import aabb.base;

namespace aabblab {

namespace {

/// CVODE's solver of one system, from the first call of `advance` on.
class bdf final : public integrator {
public:
    explicit bdf(double tolerance) : tolerance_(tolerance) {
        if (SUNContext_Create(nullptr, context_.put()) != 0) throw aabb::input_error("bdf: SUNDIALS gives no context");
    }

    void advance(const acceleration_of& acceleration, motion_state& state, double step) override {
        if (!system_) {
            system_.emplace(acceleration, state);
            start(system_->both(), state.time);
        }
        failure_ = nullptr;
        double reached = state.time;
        // It may not look beyond: what lies there may be another contact's.
        const double end = state.time + step;
        CVodeSetStopTime(memory_.get(), end);
        const int status = CVode(memory_.get(), end, values_.get(), &reached, CV_NORMAL);
        if (failure_) std::rethrow_exception(failure_);
        if (status < 0)
            throw aabb::input_error("bdf gives up after " + std::to_string(reached) + " s: CVODE says " +
                                    std::to_string(status));
        std::copy_n(N_VGetArrayPointer(values_.get()), system_->both().size(), system_->both().begin());
        system_->store(state);
        state.time = end;
    }

private:
    // Handles of SUNDIALS, let go in the reverse order.
    template <class Handle, auto Free>
    class owned {
    public:
        owned() = default;
        explicit owned(Handle handle) : handle_(handle) {}
        owned(const owned&) = delete;
        owned& operator=(const owned&) = delete;
        owned(owned&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
        owned& operator=(owned&& other) noexcept {
            std::swap(handle_, other.handle_);
            return *this;
        }
        ~owned() {
            if (handle_ != nullptr) Free(handle_);
        }
        [[nodiscard]] Handle get() const { return handle_; }
        [[nodiscard]] Handle* put() { return &handle_; }
        explicit operator bool() const { return handle_ != nullptr; }

    private:
        Handle handle_ = nullptr;
    };
    static void free_context(SUNContext context) { SUNContext_Free(&context); }
    static void free_memory(void* memory) { CVodeFree(&memory); }

    void start(const std::vector<double>& both, double time) {
        const auto size = static_cast<sunindextype>(both.size());
        values_ = owned<N_Vector, &N_VDestroy>(N_VNew_Serial(size, context_.get()));
        std::ranges::copy(both, N_VGetArrayPointer(values_.get()));
        memory_ = owned<void*, &free_memory>(CVodeCreate(CV_BDF, context_.get()));
        matrix_ = owned<SUNMatrix, &SUNMatDestroy>(SUNDenseMatrix(size, size, context_.get()));
        solver_ = owned<SUNLinearSolver, &SUNLinSolFree>(SUNLinSol_Dense(values_.get(), matrix_.get(), context_.get()));
        CVodeInit(memory_.get(), &derivative, time, values_.get());
        CVodeSStolerances(memory_.get(), tolerance_, tolerance_);
        CVodeSetUserData(memory_.get(), this);
        CVodeSetLinearSolver(memory_.get(), solver_.get(), matrix_.get());
        CVodeSetMaxNumSteps(memory_.get(), 100'000);
        CVodeSetErrHandlerFn(memory_.get(), [](int, const char*, const char*, char*, void*) {}, nullptr);
    }

    static int derivative(double time, N_Vector values, N_Vector change, void* self) {
        bdf& me = *static_cast<bdf*>(self);
        try {
            const auto size = static_cast<std::size_t>(N_VGetLength(values));
            me.from_.assign(N_VGetArrayPointer(values), N_VGetArrayPointer(values) + size);
            me.to_.resize(size);
            (*me.system_)(me.from_, me.to_, time);
            std::ranges::copy(me.to_, N_VGetArrayPointer(change));
            return 0;
        } catch (...) {
            // Nothing may be thrown through C.
            me.failure_ = std::current_exception();
            return -1;
        }
    }

    double tolerance_;
    owned<SUNContext, &free_context> context_;
    owned<N_Vector, &N_VDestroy> values_;
    owned<SUNMatrix, &SUNMatDestroy> matrix_;
    owned<SUNLinearSolver, &SUNLinSolFree> solver_;
    owned<void*, &free_memory> memory_;
    std::optional<first_order_system> system_;
    std::vector<double> from_;
    std::vector<double> to_;
    std::exception_ptr failure_;
};

}  // namespace

integrator_info bdf_integrator() {
    return {"bdf",
            "backward differences of orders 1 to 5 with Newton's method, for stiff systems (SUNDIALS' CVODE)",
            true,
            5,
            std::numeric_limits<double>::infinity(),
            [](double tolerance) -> std::unique_ptr<integrator> { return std::make_unique<bdf>(tolerance); }};
}

}  // namespace aabblab
