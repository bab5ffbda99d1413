// Rust's std: each line is when something ended, in ms since the beginning, and what.
//
//   threads serve | threads ask ADDRESS
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream, UdpSocket};
use std::process::Command;
use std::sync::{mpsc, Arc, Condvar, Mutex};
use std::thread;
use std::time::{Duration, Instant};

const PORT: u16 = 5605;

fn serve() {
    thread::spawn(|| {
        for stream in TcpListener::bind(("0.0.0.0", PORT)).unwrap().incoming() {
            let mut stream = stream.unwrap();
            let mut data = [0; 6];
            stream.read_exact(&mut data).unwrap();
            stream.write_all(&data).unwrap();
        }
    });
    let socket = UdpSocket::bind(("0.0.0.0", PORT)).unwrap();
    loop {
        let mut data = [0; 64];
        let (size, asker) = socket.recv_from(&mut data).unwrap();
        socket.send_to(&data[..size], asker).unwrap();
    }
}

fn text(data: &[u8]) -> String {
    String::from_utf8_lossy(data).into_owned()
}

fn ask(address: &str) {
    let begin = Instant::now();
    let say = |what: String| println!("{:.0} {}", begin.elapsed().as_secs_f64() * 1e3, what);

    let socket = UdpSocket::bind("0.0.0.0:0").unwrap();
    socket.set_read_timeout(Some(Duration::from_millis(150))).unwrap();
    socket.send_to(b"datagram", (address, PORT)).unwrap();
    let mut data = [0; 64];
    let size = socket.recv(&mut data).unwrap();
    say(text(&data[..size]));
    say(format!("{:?}", socket.recv(&mut data).unwrap_err().kind()));

    let mut stream = TcpStream::connect((address, PORT)).unwrap();
    stream.write_all(b"stream").unwrap();
    stream.read_exact(&mut data[..6]).unwrap();
    say(text(&data[..6]));

    let (sender, receiver) = mpsc::channel();
    for number in 0..3 {
        let sender = sender.clone();
        thread::spawn(move || {
            thread::sleep(Duration::from_millis(100 * (3 - number)));
            sender.send(number).unwrap();
        });
    }
    drop(sender);
    say(format!("{:?}", receiver.iter().collect::<Vec<_>>()));

    let pair = Arc::new((Mutex::new(false), Condvar::new()));
    let (lock, condition) = &*pair;
    let guard = lock.lock().unwrap();
    let (guard, waited) = condition.wait_timeout(guard, Duration::from_millis(200)).unwrap();
    say(format!("time is up: {}", waited.timed_out()));
    drop(guard);

    let output = Command::new("/bin/sh").args(["-c", "sleep 0.3; echo of a child"]).output();
    say(text(&output.unwrap().stdout).trim().to_string());
    loop {
        thread::park();
    }
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    match words[1].as_str() {
        "serve" => serve(),
        _ => ask(&words[2]),
    }
}
