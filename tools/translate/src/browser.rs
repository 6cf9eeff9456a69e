//! Compiles shaders in a browser: serves them on localhost, and starts Chromium without a window.

use std::{
    collections::BTreeMap,
    fs,
    io::{BufRead, BufReader, Read, Write},
    net::{TcpListener, TcpStream},
    path::PathBuf,
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

const PAGE: &str = include_str!("page.html");

/// The names under which systems have the browser.
const BROWSERS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// What is not ours: the start of each message, and whose it is. None of it is in shaders that the
/// engine builds for browsers, but for the last.
const KNOWN: [(&str, &str); 3] = [
    (
        "binding_array element type",
        "materials without bind groups are not for browsers",
    ),
    (
        "cannot call built-in function 'subgroup",
        "naga leaves out `enable subgroups`; the crate has none in browsers",
    ),
    (
        "value cannot be represented as 'f32'",
        "FLOAT_MAX of the engine's environment maps as naga 29 writes it",
    ),
];

fn known(error: &str) -> Option<&'static str> {
    KNOWN
        .iter()
        .find(|(start, _)| error.starts_with(start))
        .map(|(_, whose)| *whose)
}

/// How long the browser may be silent.
const PATIENCE: Duration = Duration::from_secs(120);

/// A request: method, path, body.
struct Request {
    method: String,
    path: String,
    body: String,
}

fn read(stream: &TcpStream) -> std::io::Result<Request> {
    let mut reader = BufReader::new(stream);
    let mut first = String::new();
    reader.read_line(&mut first)?;
    let mut words = first.split_whitespace().map(str::to_owned);
    let (method, path) = (
        words.next().unwrap_or_default(),
        words.next().unwrap_or_default(),
    );
    let mut length = 0;
    loop {
        let mut line = String::new();
        reader.read_line(&mut line)?;
        let line = line.trim().to_ascii_lowercase();
        if line.is_empty() {
            break;
        }
        if let Some(text) = line.strip_prefix("content-length:") {
            length = text.trim().parse().unwrap_or(0);
        }
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body)?;
    Ok(Request {
        method,
        path,
        body: String::from_utf8_lossy(&body).into_owned(),
    })
}

fn answer(mut stream: &TcpStream, kind: &str, text: &str) -> std::io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{text}",
        text.len()
    )
}

/// Starts the browser with a software adapter, which every machine has.
fn start(address: &str) -> Result<Child, String> {
    let arguments = [
        "--headless=new",
        "--no-sandbox",
        "--enable-unsafe-webgpu",
        "--use-webgpu-adapter=swiftshader",
        address,
    ];
    for browser in BROWSERS {
        let child = Command::new(browser)
            .args(arguments)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        if let Ok(child) = child {
            return Ok(child);
        }
    }
    Err(format!(
        "no browser: none of {} is installed",
        BROWSERS.join(", ")
    ))
}

/// What a browser said.
#[derive(Default)]
struct Said {
    adapter: String,
    compiled: usize,
    refused: usize,
    /// Errors: the first file of each.
    errors: BTreeMap<String, String>,
    done: bool,
}

impl Said {
    fn hear(&mut self, request: &Request, files: &[PathBuf]) {
        let file = |path: &str| {
            let index = path
                .rsplit('/')
                .next()
                .and_then(|text| text.parse::<usize>().ok());
            index.and_then(|index| files.get(index))
        };
        match request.path.as_str() {
            "/adapter" => self.adapter = request.body.clone(),
            "/done" => self.done = true,
            "/failed" => {
                self.errors.insert(request.body.clone(), "the page".into());
                self.done = true;
            }
            path if path.starts_with("/good/") => self.compiled += 1,
            path => {
                if let Some(file) = file(path) {
                    self.refused += 1;
                    // The same error is on other lines of other files.
                    let end = request.body.find(" (line").unwrap_or(request.body.len());
                    let kind = request.body[..end].to_owned();
                    let example = || format!("{}:\n{}", file.display(), request.body);
                    self.errors.entry(kind).or_insert_with(example);
                }
            }
        }
    }
}

/// Whether browsers get a shader: devices that cannot number triangles have no sections.
fn is_for_browsers(text: &str) -> bool {
    !text.contains("enable primitive_index;")
}

/// Compiles every file. Whether all are valid in the browser, but for what is known.
pub fn compile(all: &[PathBuf]) -> Result<bool, String> {
    let mut files = Vec::new();
    let mut texts = Vec::new();
    for file in all {
        let text = fs::read_to_string(file);
        let text = text.map_err(|error| format!("{}: {error}", file.display()))?;
        if is_for_browsers(&text) {
            files.push(file.clone());
            texts.push(text);
        }
    }
    let listener = TcpListener::bind("127.0.0.1:0").map_err(|error| error.to_string())?;
    let address = listener.local_addr().map_err(|error| error.to_string())?;
    listener
        .set_nonblocking(true)
        .map_err(|error| error.to_string())?;
    let mut browser = start(&format!("http://{address}/"))?;
    let page = PAGE.replace("COUNT", &files.len().to_string());
    let mut said = Said::default();
    let mut heard = Instant::now();
    while !said.done && heard.elapsed() < PATIENCE {
        let Ok((stream, _)) = listener.accept() else {
            std::thread::sleep(Duration::from_millis(1));
            continue;
        };
        heard = Instant::now();
        let _ = stream.set_nonblocking(false);
        let Ok(request) = read(&stream) else {
            continue;
        };
        let text = match (request.method.as_str(), request.path.as_str()) {
            ("GET", "/") => page.clone(),
            ("GET", path) => {
                let index = path[1..].parse().ok();
                let text = index.and_then(|index: usize| texts.get(index));
                text.cloned().unwrap_or_default()
            }
            _ => {
                said.hear(&request, &files);
                String::new()
            }
        };
        let kind = if request.path == "/" {
            "text/html"
        } else {
            "text/plain"
        };
        let _ = answer(&stream, kind, &text);
    }
    let _ = browser.kill();
    let _ = browser.wait();
    println!("browser: {}", said.adapter);
    println!(
        "{} of {} files are valid in the browser; {} more are not for browsers",
        said.compiled,
        files.len(),
        all.len() - files.len()
    );
    for (error, file) in &said.errors {
        let whose = known(error).map_or_else(String::new, |whose| format!(" (known: {whose})"));
        println!("\n## {error}{whose}\n{file}");
    }
    if !said.done {
        return Err("the browser did not answer".into());
    }
    let heard = said.compiled + said.refused;
    if heard != files.len() {
        return Err(format!("answers for {heard} of {} files", files.len()));
    }
    Ok(said.errors.keys().all(|error| known(error).is_some()))
}
