//! The object that every other SUNDIALS object belongs to.

use std::cell::RefCell;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr;
use std::rc::Rc;
use sundials_sys::{
    SUNContext, SUNContext_ClearErrHandlers, SUNContext_Create, SUNContext_Free, SUNContext_PushErrHandler, SUNContext_SetLogger,
};

/// Owner of one `SUNContext`; clones share it and the last one frees it.
#[derive(Clone)]
pub struct Context(Rc<Inner>);

struct Inner {
    raw: SUNContext,
    /// Last message of the library; its address is registered with the library, so it has its own allocation.
    message: Box<RefCell<String>>,
}

impl Context {
    /// A context whose messages are kept instead of printed.
    pub fn new() -> Self {
        let message = Box::new(RefCell::new(String::new()));
        let mut raw: SUNContext = ptr::null_mut();
        // SAFETY: `raw` is a valid place for the result; the handler and the message live as long as the context.
        unsafe {
            let failed = SUNContext_Create(sundials_sys::SUN_COMM_NULL, &mut raw);
            assert!(failed == 0 && !raw.is_null(), "out of memory while creating a SUNDIALS context");
            SUNContext_ClearErrHandlers(raw);
            // warnings go past the handlers and would be printed
            SUNContext_SetLogger(raw, ptr::null_mut());
            SUNContext_PushErrHandler(raw, Some(keep_message), ptr::from_ref(&*message).cast_mut().cast());
        }
        Self(Rc::new(Inner { raw, message }))
    }

    /// The handle for calls into the library.
    pub fn raw(&self) -> SUNContext {
        self.0.raw
    }

    /// Last message of the library.
    pub fn message(&self) -> String {
        self.0.message.borrow().clone()
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        // SAFETY: created by SUNContext_Create; every object of this context held a clone, so all are gone.
        unsafe {
            SUNContext_Free(&mut self.raw);
        }
    }
}

/// Replaces the library's own handler, which prints to the standard error stream.
extern "C" fn keep_message(
    _line: c_int,
    _function: *const c_char,
    _file: *const c_char,
    text: *const c_char,
    _code: c_int,
    keeper: *mut c_void,
    _context: SUNContext,
) {
    if text.is_null() || keeper.is_null() {
        return;
    }
    // SAFETY: `keeper` is the message cell registered in `Context::new`, `text` a terminated string of the library.
    let (keeper, text) = unsafe { (&*keeper.cast::<RefCell<String>>(), CStr::from_ptr(text)) };
    if let Ok(mut message) = keeper.try_borrow_mut() {
        message.clear();
        message.push_str(&text.to_string_lossy());
    }
}
