//! Model and loop behind their handles.

use crate::border::{Checked, check, guarded};
use crate::status::{BAD_HANDLE, BUSY, PANIC, POISONED};
use funicular::control_loop::{ControlLoop, LoopModel};
use std::cell::UnsafeCell;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

/// Numbers that say what is at an address; zero after its end.
const MODEL: u64 = 0x666e_5f6d_6f64_656c;
const LOOP: u64 = 0x666e_5f6c_6f6f_7021;

/// `fn_model`: a robot, read only.
#[repr(C)]
pub struct Model {
    kind: AtomicU64,
    /// Number of loops that have not ended.
    loops: AtomicU32,
    pub(crate) checked: LoopModel,
}

/// `fn_loop`: the memory of a loop.
#[repr(C)]
pub struct Loop {
    kind: AtomicU64,
    busy: AtomicBool,
    poisoned: AtomicBool,
    model: *const Model,
    state: UnsafeCell<ControlLoop>,
}

impl Model {
    pub(crate) fn new(model: LoopModel) -> Box<Self> {
        Box::new(Self { kind: AtomicU64::new(MODEL), loops: AtomicU32::new(0), checked: model })
    }

    /// Model at an address.
    ///
    /// # Safety
    /// If not null, the address was returned by this library, and the model was not freed.
    pub(crate) unsafe fn at<'a>(address: *const Self) -> Checked<&'a Self> {
        check(address)?;
        // SAFETY: the caller promises that a model is there.
        let model = unsafe { &*address };
        if model.kind.load(Ordering::Acquire) == MODEL { Ok(model) } else { Err(BAD_HANDLE) }
    }

    /// True if it had no loops; from then on it is none any more.
    pub(crate) fn end(&self) -> bool {
        let ended = self.loops.compare_exchange(0, u32::MAX, Ordering::AcqRel, Ordering::Acquire).is_ok();
        if ended {
            self.kind.store(0, Ordering::Release);
        }
        ended
    }

    /// Counts a loop; false for a model that has ended.
    fn add_loop(&self) -> bool {
        let more = |count: u32| count.checked_add(1).filter(|next| *next < u32::MAX);
        self.loops.fetch_update(Ordering::AcqRel, Ordering::Acquire, more).is_ok()
    }
}

impl Loop {
    /// Loop of a model; `None` for a model that has ended.
    pub(crate) fn new(model: &Model) -> Option<Self> {
        model.add_loop().then(|| Self {
            kind: AtomicU64::new(LOOP),
            busy: AtomicBool::new(false),
            poisoned: AtomicBool::new(false),
            model,
            state: UnsafeCell::new(ControlLoop::new()),
        })
    }

    /// Loop at an address.
    ///
    /// # Safety
    /// If not null, at least as many readable bytes as a loop has are there, which were initialised once.
    unsafe fn at<'a>(address: *const Self) -> Checked<&'a Self> {
        check(address)?;
        // SAFETY: the caller promises initialised memory; all but the state is atomic or never changes.
        let this = unsafe { &*address };
        if this.kind.load(Ordering::Acquire) == LOOP { Ok(this) } else { Err(BAD_HANDLE) }
    }

    /// Runs a call with the model and the state of the loop at an address; one thread at a time.
    ///
    /// # Safety
    /// As for [`Self::at`].
    pub(crate) unsafe fn call(
        address: *const Self,
        work: impl FnOnce(&LoopModel, &mut ControlLoop) -> Checked<i32>,
    ) -> i32 {
        // SAFETY: promised by the caller.
        let this = match unsafe { Self::at(address) } {
            Ok(this) => this,
            Err(status) => return status,
        };
        if this.busy.compare_exchange(false, true, Ordering::Acquire, Ordering::Relaxed).is_err() {
            return BUSY;
        }
        let status = if this.poisoned.load(Ordering::Relaxed) {
            POISONED
        } else {
            // SAFETY: a model does not end before its loops, and `busy` makes this the only reference to the state.
            let (model, state) = unsafe { (&(*this.model).checked, &mut *this.state.get()) };
            guarded(|| work(model, state).unwrap_or_else(|status| status)).unwrap_or_else(|| {
                this.poisoned.store(true, Ordering::Relaxed);
                PANIC
            })
        };
        this.busy.store(false, Ordering::Release);
        status
    }

    /// Ends the loop at an address; its memory is the caller's again.
    ///
    /// # Safety
    /// As for [`Self::at`].
    pub(crate) unsafe fn end(address: *const Self) -> Checked<()> {
        // SAFETY: promised by the caller.
        let this = unsafe { Self::at(address) }?;
        if this.busy.compare_exchange(false, true, Ordering::Acquire, Ordering::Relaxed).is_err() {
            return Err(BUSY);
        }
        // A second thread that ends it too finds either `busy` or no loop.
        if this.kind.swap(0, Ordering::AcqRel) != LOOP {
            return Err(BAD_HANDLE);
        }
        // SAFETY: a model does not end before its loops.
        let model = unsafe { &*this.model };
        model.loops.fetch_sub(1, Ordering::AcqRel);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::status::CERTIFIED;
    use funicular::robot::Robot;

    #[test]
    fn a_panic_ends_at_the_border_and_its_loop_is_of_no_use_any_more() {
        let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
        let model = Model::new(LoopModel::new(robot).unwrap());
        let [broken, whole] = [(); 2].map(|()| Loop::new(&model).unwrap());
        // SAFETY: both are loops of a model that lives.
        unsafe {
            assert_eq!(Loop::call(&raw const broken, |_, _| panic!("on purpose")), PANIC);
            assert_eq!(Loop::call(&raw const broken, |_, _| Ok(CERTIFIED)), POISONED);
            assert_eq!(Loop::call(&raw const whole, |_, _| Ok(CERTIFIED)), CERTIFIED);

            // A call inside a call is a second user, as another thread would be.
            let inside = Loop::call(&raw const whole, |_, _| Ok(Loop::call(&raw const whole, |_, _| Ok(CERTIFIED))));
            assert_eq!(inside, BUSY);
            assert!(!model.end());
            assert!(Loop::end(&raw const broken).is_ok() && Loop::end(&raw const whole).is_ok());
            assert!(model.end() && !model.end() && Loop::new(&model).is_none());
            assert_eq!(Loop::call(&raw const whole, |_, _| Ok(CERTIFIED)), BAD_HANDLE);
        }
    }
}
