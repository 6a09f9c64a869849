//! The C interface of FMI 3.0.
//!
//! The only file of the workspace with `unsafe`: a library that a simulator loads exports functions of C, which get pointers. What they
//! rest on is said at each block, and follows from three promises of the standard:
//! - an instance is the pointer that `fmi3InstantiateCoSimulation` gave, is used by one call at a time, and not after `fmi3FreeInstance`;
//! - an array has as many elements as its number says; texts end with a zero;
//! - the function for messages may be called during each call with an instance.
//!
//! No panic leaves a function: it becomes `fmi3Fatal`. Functions without a use here (model exchange, clocks, states, other types) answer
//! `fmi3Error`. They are declared with the instance alone: on 64-bit platforms callers pass and remove arguments, and these are not read.

#![expect(
    unsafe_code,
    reason = "a C interface is exported functions with pointers; the standard names them"
)]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use crate::error::UnitError;
use crate::unit::Unit;

/// `fmi3Status`.
type Status = c_int;
const OK: Status = 0;
const WARNING: Status = 1;
const DISCARD: Status = 2;
const ERROR: Status = 3;
const FATAL: Status = 4;

/// `fmi3LogMessageCallback`: environment, status, category, message.
type LogMessage = Option<unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char)>;

/// What a simulator's pointer to an instance points to.
struct Instance {
    unit: Unit,
    log: Log,
}

/// Where messages go.
struct Log {
    environment: *mut c_void,
    message: LogMessage,
}

impl Log {
    fn say(&self, status: Status, text: &str) {
        let category = if status == OK {
            c"logStatusOK"
        } else {
            c"logStatusError"
        };
        if let (Some(message), Ok(text)) = (self.message, CString::new(text)) {
            // SAFETY: the simulator gave this function and its environment for this use; both texts outlive the call.
            unsafe { message(self.environment, status, category.as_ptr(), text.as_ptr()) };
        }
    }
}

/// Calls a function with an instance, and says why it fails.
///
/// # Arguments
/// - `refused`: the status where the model refuses the condition; any other failure is `fmi3Error`.
fn with(
    instance: *mut Instance,
    refused: Status,
    call: impl FnOnce(&mut Unit) -> Result<(), UnitError>,
) -> Status {
    // SAFETY: null, or the pointer to a live instance that no other call uses.
    let Some(instance) = (unsafe { instance.as_mut() }) else {
        return ERROR;
    };
    let Instance { unit, log } = instance;
    match catch_unwind(AssertUnwindSafe(|| call(unit))) {
        Ok(Ok(())) => OK,
        Ok(Err(error)) => {
            let status = status(&error, refused);
            log.say(status, &error.to_string());
            status
        }
        Err(_) => FATAL,
    }
}

/// Returns the status of a failure: another condition may succeed after a refusal alone.
fn status(error: &UnitError, refused: Status) -> Status {
    match error {
        UnitError::Refused { .. } => refused,
        _ => ERROR,
    }
}

/// Returns the elements of an array.
///
/// # Safety
/// It has this number of them, or the number is 0.
unsafe fn elements<'a, T>(array: *const T, number: usize) -> &'a [T] {
    match array.is_null() || number == 0 {
        true => &[],
        // SAFETY: the caller's promise.
        false => unsafe { std::slice::from_raw_parts(array, number) },
    }
}

/// Returns the elements of an array, writable.
///
/// # Safety
/// It has this number of them, or the number is 0; nothing else reads or writes them meanwhile.
unsafe fn elements_mut<'a, T>(array: *mut T, number: usize) -> &'a mut [T] {
    match array.is_null() || number == 0 {
        true => &mut [],
        // SAFETY: the caller's promise.
        false => unsafe { std::slice::from_raw_parts_mut(array, number) },
    }
}

/// Returns a text; nothing if there is none or it is no UTF-8.
///
/// # Safety
/// The text is null or ends with a zero.
unsafe fn text<'a>(text: *const c_char) -> Option<&'a str> {
    if text.is_null() {
        return None;
    }
    // SAFETY: the caller's promise.
    unsafe { CStr::from_ptr(text) }.to_str().ok()
}

/// Writes what a simulator asks for, where it gives room.
///
/// # Safety
/// The room is null or that of one value.
unsafe fn put<T>(room: *mut T, value: T) {
    // SAFETY: the caller's promise.
    if let Some(room) = unsafe { room.as_mut() } {
        *room = value;
    }
}

/// Returns the version of the interface.
#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Reads the model and returns an instance; null, with a message, if there is none.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    _logging_on: bool,
    _event_mode_used: bool,
    _early_return_allowed: bool,
    _intermediate_variables: *const u32,
    _intermediate_variable_number: usize,
    environment: *mut c_void,
    message: LogMessage,
    _intermediate_update: *const c_void,
) -> *mut Instance {
    let log = Log { environment, message };
    // SAFETY: the standard's texts end with a zero.
    let (token, resources) = unsafe { (text(token), text(resources)) };
    let (Some(token), Some(resources)) = (token, resources) else {
        log.say(
            ERROR,
            "there is no instantiation token, or no path of the resources",
        );
        return std::ptr::null_mut();
    };
    match catch_unwind(|| Unit::open(Path::new(resources), token)) {
        Ok(Ok(unit)) => Box::into_raw(Box::new(Instance { unit, log })),
        Ok(Err(error)) => {
            log.say(ERROR, &error.to_string());
            std::ptr::null_mut()
        }
        Err(_) => std::ptr::null_mut(),
    }
}

/// Frees an instance.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeInstance(instance: *mut Instance) {
    if !instance.is_null() {
        // SAFETY: it came from `Box::into_raw`, and is not used any more.
        drop(unsafe { Box::from_raw(instance) });
    }
}

/// Begins the initialisation.
#[unsafe(no_mangle)]
extern "C" fn fmi3EnterInitializationMode(
    instance: *mut Instance,
    _tolerance_defined: bool,
    _tolerance: f64,
    start_s: f64,
    _stop_defined: bool,
    _stop_s: f64,
) -> Status {
    with(instance, ERROR, |unit| {
        unit.time_s = start_s;
        unit.begin_initialisation();
        Ok(())
    })
}

/// Ends the initialisation: the outputs are those of the inputs so far. A refused condition is a warning, because inputs may follow.
#[unsafe(no_mangle)]
extern "C" fn fmi3ExitInitializationMode(instance: *mut Instance) -> Status {
    with(instance, WARNING, |unit| {
        unit.end_initialisation();
        unit.simulate()
    })
}

/// Sets all variables to their start values.
#[unsafe(no_mangle)]
extern "C" fn fmi3Reset(instance: *mut Instance) -> Status {
    with(instance, ERROR, |unit| {
        unit.reset();
        Ok(())
    })
}

/// Makes a step: the outputs are the averages of a steady run under the inputs. A condition that the model refuses is `fmi3Discard`.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    instance: *mut Instance,
    current_s: f64,
    step_s: f64,
    _no_state_before: bool,
    event_needed: *mut bool,
    terminate: *mut bool,
    early_return: *mut bool,
    last_time_s: *mut f64,
) -> Status {
    let status = with(instance, DISCARD, |unit| {
        unit.simulate()?;
        unit.time_s = current_s + step_s;
        Ok(())
    });
    // SAFETY: room for one value each, or null.
    unsafe {
        put(event_needed, false);
        put(terminate, false);
        put(early_return, false);
        put(
            last_time_s,
            if status == OK {
                current_s + step_s
            } else {
                current_s
            },
        );
    }
    status
}

/// Reads or writes variables of a type by their value references.
macro_rules! access {
    ($name:ident, $values:ty, $elements:ident, $doc:literal, |$unit:ident, $reference:ident, $value:ident| $call:expr) => {
        #[doc = $doc]
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(
            instance: *mut Instance,
            references: *const u32,
            reference_number: usize,
            values: $values,
            value_number: usize,
        ) -> Status {
            // SAFETY: the standard's arrays have these numbers of elements.
            let (references, values) = unsafe {
                (
                    elements(references, reference_number),
                    $elements(values, value_number),
                )
            };
            if references.len() != values.len() {
                return ERROR;
            }
            with(instance, ERROR, |$unit| {
                for (&$reference, $value) in references.iter().zip(values) {
                    $call;
                }
                Ok(())
            })
        }
    };
}

access!(
    fmi3GetFloat64,
    *mut f64,
    elements_mut,
    "Reads real variables. In the initialisation mode, the first reading of an output simulates.",
    |unit, reference, value| { *value = unit.real(reference)? }
);
access!(
    fmi3SetFloat64,
    *const f64,
    elements,
    "Sets inputs.",
    |unit, reference, value| unit.set_real(reference, *value)?
);
access!(
    fmi3GetInt32,
    *mut i32,
    elements_mut,
    "Reads the number of the draw.",
    |unit, reference, value| { *value = unit.whole(reference)? }
);
access!(
    fmi3SetInt32,
    *const i32,
    elements,
    "Chooses a draw.",
    |unit, reference, value| unit.set_whole(reference, *value)?
);

/// Functions that change nothing here and answer that all is well, or that they have no use here.
macro_rules! answer {
    ($status:expr, $doc:literal: $($name:ident)*) => {$(
        #[doc = $doc]
        #[unsafe(no_mangle)]
        extern "C" fn $name(_instance: *mut Instance) -> Status {
            $status
        }
    )*};
}

answer!(OK, "Nothing changes here.":
    fmi3SetDebugLogging fmi3EnterStepMode fmi3EnterConfigurationMode fmi3ExitConfigurationMode fmi3Terminate
);
answer!(ERROR, "Not offered.":
    fmi3EnterEventMode fmi3UpdateDiscreteStates fmi3EvaluateDiscreteStates fmi3EnterContinuousTimeMode
    fmi3GetFloat32 fmi3GetInt8 fmi3GetUInt8 fmi3GetInt16 fmi3GetUInt16 fmi3GetUInt32 fmi3GetInt64 fmi3GetUInt64 fmi3GetBoolean
    fmi3GetString fmi3GetBinary fmi3GetClock
    fmi3SetFloat32 fmi3SetInt8 fmi3SetUInt8 fmi3SetInt16 fmi3SetUInt16 fmi3SetUInt32 fmi3SetInt64 fmi3SetUInt64 fmi3SetBoolean
    fmi3SetString fmi3SetBinary fmi3SetClock
    fmi3GetNumberOfVariableDependencies fmi3GetVariableDependencies fmi3GetDirectionalDerivative fmi3GetAdjointDerivative
    fmi3GetOutputDerivatives
    fmi3GetFMUState fmi3SetFMUState fmi3FreeFMUState fmi3SerializedFMUStateSize fmi3SerializeFMUState fmi3DeserializeFMUState
    fmi3GetIntervalDecimal fmi3GetIntervalFraction fmi3GetShiftDecimal fmi3GetShiftFraction
    fmi3SetIntervalDecimal fmi3SetIntervalFraction fmi3SetShiftDecimal fmi3SetShiftFraction
    fmi3CompletedIntegratorStep fmi3SetTime fmi3SetContinuousStates fmi3GetContinuousStateDerivatives fmi3GetEventIndicators
    fmi3GetContinuousStates fmi3GetNominalsOfContinuousStates fmi3GetNumberOfEventIndicators fmi3GetNumberOfContinuousStates
    fmi3ActivateModelPartition
);

/// Not offered: there is no instance for model exchange.
#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateModelExchange() -> *mut Instance {
    std::ptr::null_mut()
}

/// Not offered: there is no instance for scheduled execution.
#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateScheduledExecution() -> *mut Instance {
    std::ptr::null_mut()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_condition_alone_may_be_discarded() {
        let refused = UnitError::Refused {
            refused: 2,
            draws: 2,
            first: String::new(),
        };
        assert_eq!(status(&refused, DISCARD), DISCARD);
        assert_eq!(status(&refused, WARNING), WARNING);
        assert_eq!(status(&UnitError::Model("no equations".into()), DISCARD), ERROR);
        assert_eq!(status(&UnitError::Model("no equations".into()), WARNING), ERROR);
    }
}
