//! What no pointer and no key can do: another program on the display, which lets files fall on a window as file managers do
//! (XDND), and hides it as window managers do.

use std::fmt::Write as _;
use std::os::unix::ffi::OsStrExt as _;
use std::path::Path;
use std::time::{Duration, Instant};

use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConnectionExt as _, CreateWindowAux, EventMask, PropMode,
    SELECTION_NOTIFY_EVENT, SelectionNotifyEvent, SelectionRequestEvent, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;
use x11rb::{COPY_FROM_PARENT, CURRENT_TIME, NONE};

use super::PATIENCE;

const FAILS: &str = "the display answers";

/// The version of XDND that is spoken, where the protocol wants it.
const VERSION: u32 = 5 << 24;

/// A program that talks to the display.
pub struct Client {
    connection: RustConnection,
    root: u32,
    /// A window of its own, which nobody sees.
    own: u32,
}

impl Client {
    /// Connects to the display of this name.
    pub(super) fn new(display: &str) -> Self {
        let (connection, screen) = x11rb::connect(Some(display)).expect(FAILS);
        let root = connection.setup().roots[screen].root;
        let own = connection.generate_id().expect(FAILS);
        let attributes = CreateWindowAux::new();
        let class = WindowClass::INPUT_ONLY;
        connection
            .create_window(0, own, root, 0, 0, 1, 1, 0, class, COPY_FROM_PARENT, &attributes)
            .expect(FAILS);
        Self { connection, root, own }
    }

    fn atom(&self, name: &str) -> u32 {
        let cookie = self.connection.intern_atom(false, name.as_bytes()).expect(FAILS);
        cookie.reply().expect(FAILS).atom
    }

    /// The window whose title ends like this, which has no window manager's frame around it.
    ///
    /// # Panics
    /// If there is none.
    #[must_use]
    pub fn find(&self, title: &str) -> u32 {
        let tree = self.connection.query_tree(self.root).expect(FAILS).reply().expect(FAILS);
        let has_title = |window: &u32| {
            let (of, kind) = (AtomEnum::WM_NAME, AtomEnum::ANY);
            let name = self.connection.get_property(false, *window, of, kind, 0, 64).expect(FAILS).reply();
            name.is_ok_and(|name| name.value.ends_with(title.as_bytes()))
        };
        tree.children.into_iter().find(has_title).expect("the window is there")
    }

    /// Hides a window, or shows it again, and says so to it.
    ///
    /// # Panics
    /// If the display fails.
    pub fn minimise(&self, window: u32, hidden: bool) {
        let (state, flag) = (self.atom("_NET_WM_STATE"), self.atom("_NET_WM_STATE_HIDDEN"));
        let flags = if hidden { vec![flag] } else { Vec::new() };
        let kind = AtomEnum::ATOM;
        self.connection.change_property32(PropMode::REPLACE, window, state, kind, &flags).expect(FAILS);
        if hidden {
            self.connection.unmap_window(window).expect(FAILS);
        } else {
            self.connection.map_window(window).expect(FAILS);
        }
        self.connection.sync().expect(FAILS);
    }

    /// Holds a file over the middle of a window until `look` has returned, and lets it fall.
    ///
    /// # Panics
    /// If the window does not take it.
    pub fn drop_file(&self, window: u32, file: &Path, look: impl FnOnce()) {
        let selection = self.atom("XdndSelection");
        self.connection.set_selection_owner(self.own, selection, CURRENT_TIME).expect(FAILS);
        let list = self.atom("text/uri-list");
        self.tell(window, "XdndEnter", [self.own, VERSION, list, 0, 0]);
        let place = self.connection.get_geometry(window).expect(FAILS).reply().expect(FAILS);
        let middle = [place.x + place.width as i16 / 2, place.y + place.height as i16 / 2];
        let middle = u32::from(middle[0] as u16) << 16 | u32::from(middle[1] as u16);
        let action = self.atom("XdndActionCopy");
        self.tell(window, "XdndPosition", [self.own, 0, middle, CURRENT_TIME, action]);
        // Whether it is welcome is answered before the file is asked for.
        let status = self.atom("XdndStatus");
        let (mut welcome, mut given) = (false, false);
        self.until(|event| {
            match event {
                Event::SelectionRequest(request) => {
                    self.give(&request, &uri(file));
                    given = true;
                }
                Event::ClientMessage(message) if message.type_ == status => {
                    welcome = message.data.as_data32()[1] & 1 == 1;
                    assert!(welcome, "the window wants no files");
                }
                _ => {}
            }
            welcome && given
        });
        look();
        self.tell(window, "XdndDrop", [self.own, 0, CURRENT_TIME, 0, 0]);
        let finished = self.atom("XdndFinished");
        self.until(|event| matches!(event, Event::ClientMessage(message) if message.type_ == finished));
    }

    fn tell(&self, window: u32, message: &str, data: [u32; 5]) {
        let event = ClientMessageEvent::new(32, window, self.atom(message), data);
        self.connection.send_event(false, window, EventMask::NO_EVENT, event).expect(FAILS);
        self.connection.flush().expect(FAILS);
    }

    fn give(&self, request: &SelectionRequestEvent, text: &str) {
        let (to, property, kind) = (request.requestor, request.property, request.target);
        self.connection
            .change_property8(PropMode::REPLACE, to, property, kind, text.as_bytes())
            .expect(FAILS);
        let event = SelectionNotifyEvent {
            response_type: SELECTION_NOTIFY_EVENT,
            sequence: 0,
            time: request.time,
            requestor: to,
            selection: request.selection,
            target: kind,
            property: if kind == NONE { NONE } else { property },
        };
        self.connection.send_event(false, to, EventMask::NO_EVENT, event).expect(FAILS);
        self.connection.flush().expect(FAILS);
    }

    /// Takes events until one is as it should be.
    fn until(&self, mut is_it: impl FnMut(Event) -> bool) {
        let begin = Instant::now();
        while begin.elapsed() < PATIENCE {
            match self.connection.poll_for_event().expect(FAILS) {
                Some(event) if is_it(event.clone()) => return,
                Some(_) => {}
                None => std::thread::sleep(Duration::from_millis(5)),
            }
        }
        panic!("the window does not answer");
    }
}

/// A file as `text/uri-list` has it.
fn uri(file: &Path) -> String {
    let mut text = "file://".to_owned();
    for &byte in file.as_os_str().as_bytes() {
        if byte.is_ascii_alphanumeric() || b"/-_.~".contains(&byte) {
            text.push(char::from(byte));
        } else {
            write!(text, "%{byte:02X}").expect("a string takes all");
        }
    }
    text + "\r\n"
}
