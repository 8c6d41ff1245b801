module;
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunmatrix/sunmatrix_dense.h>

module aabblab.stepping;

import :first_order;
import aabb.base;

namespace aabblab {

namespace {

/// Wraps CVODE (Hindmarsh et al. 2005) for one system, which the first call of `advance` fixes.
class bdf final : public integrator {
public:
    explicit bdf(double tolerance) : tolerance_(tolerance) {
        SUNContext context = nullptr;
        if (SUNContext_Create(nullptr, &context) != 0) throw aabb::input_error("bdf: SUNDIALS cannot create a context");
        context_.reset(context);
    }

    /// Advances the state by `step`. CVODE continues from the earlier calls; an exception of the callback is rethrown.
    void advance(const equations_of_motion& equations, motion_state& state, double step) override {
        if (!system_) {
            system_.emplace(equations, state);
            create_solver(system_->values(), state.time);
        }
        callback_exception_ = nullptr;
        double reached = state.time;
        // CVODE must not overstep the end, since contacts may differ there.
        const double end = state.time + step;
        CVodeSetStopTime(memory_.get(), end);
        const int status = CVode(memory_.get(), end, values_.get(), &reached, CV_NORMAL);
        if (callback_exception_) std::rethrow_exception(callback_exception_);
        if (status < 0)
            throw aabb::input_error("bdf gives up after " + std::to_string(reached) + " s: CVODE says " +
                                    std::to_string(status));
        std::copy_n(N_VGetArrayPointer(values_.get()), system_->values().size(), system_->values().begin());
        system_->store(state);
        state.time = end;
    }

private:
    // Handles of SUNDIALS, released in reverse order.
    template <auto Free>
    struct freed_by {
        template <class T>
        void operator()(T* handle) const {
            if constexpr (std::invocable<decltype(Free), T*>)
                Free(handle);
            else
                Free(&handle);
        }
    };
    template <class Handle, auto Free>
    using owned = std::unique_ptr<std::remove_pointer_t<Handle>, freed_by<Free>>;

    /// Sets CVODE up for these values: backward differences, Newton's method, no messages. Linear systems of many
    /// values are solved by GMRES without a matrix, whose columns would cost a force each.
    void create_solver(const std::vector<double>& initial, double time) {
        const auto size = static_cast<sunindextype>(initial.size());
        values_.reset(N_VNew_Serial(size, context_.get()));
        std::ranges::copy(initial, N_VGetArrayPointer(values_.get()));
        memory_.reset(CVodeCreate(CV_BDF, context_.get()));
        constexpr sunindextype most_of_dense = 100;
        if (size <= most_of_dense) {
            matrix_.reset(SUNDenseMatrix(size, size, context_.get()));
            solver_.reset(SUNLinSol_Dense(values_.get(), matrix_.get(), context_.get()));
        } else {
            solver_.reset(SUNLinSol_SPGMR(values_.get(), SUN_PREC_NONE, /*maxl=*/0, context_.get()));
        }
        CVodeInit(memory_.get(), &derivative, time, values_.get());
        CVodeSStolerances(memory_.get(), tolerance_, tolerance_);
        CVodeSetUserData(memory_.get(), this);
        CVodeSetLinearSolver(memory_.get(), solver_.get(), matrix_.get());
        CVodeSetMaxNumSteps(memory_.get(), 100'000);
        CVodeSetErrHandlerFn(memory_.get(), [](int, const char*, const char*, char*, void*) {}, nullptr);
    }

    /// CVODE's callback, which writes the derivative of `values` to `change`. `self` is the bdf of CVodeSetUserData.
    /// @returns 0, or -1 after an exception
    static int derivative(double time, N_Vector values, N_Vector change, void* self) {
        bdf& solver = *static_cast<bdf*>(self);
        try {
            const auto size = static_cast<std::size_t>(N_VGetLength(values));
            solver.input_.assign(N_VGetArrayPointer(values), N_VGetArrayPointer(values) + size);
            solver.output_.resize(size);
            (*solver.system_)(solver.input_, solver.output_, time);
            std::ranges::copy(solver.output_, N_VGetArrayPointer(change));
            return 0;
        } catch (...) {
            // Exceptions must not pass through C code.
            solver.callback_exception_ = std::current_exception();
            return -1;
        }
    }

    double tolerance_;
    owned<SUNContext, &SUNContext_Free> context_;
    owned<N_Vector, &N_VDestroy> values_;
    owned<SUNMatrix, &SUNMatDestroy> matrix_;
    owned<SUNLinearSolver, &SUNLinSolFree> solver_;
    owned<void*, &CVodeFree> memory_;
    std::optional<first_order_system> system_;
    std::vector<double> input_, output_;  // of the callback
    std::exception_ptr callback_exception_;
};

}  // namespace

integrator_info bdf_integrator() {
    return {
        .name = "bdf",
        .summary = "backward differences of orders 1 to 5 with Newton's method, for stiff systems (SUNDIALS' CVODE)",
        .adaptive = true,
        .order = 5,
        .make = [](double tolerance) -> std::unique_ptr<integrator> { return std::make_unique<bdf>(tolerance); }};
}

}  // namespace aabblab
