// A page of headless Chromium, spoken with over its pipe: no library, no port.
'use strict';

const {spawn} = require('child_process');
const fs = require('fs');
const os = require('os');
const path = require('path');

const kNames = ['chromium', 'chromium-browser', 'google-chrome'];

/// The first of the programs on the PATH, or null.
function findChromium() {
  for (const name of kNames) {
    for (const folder of (process.env.PATH ?? '').split(':')) {
      const file = path.join(folder, name);
      if (folder && fs.existsSync(file)) return file;
    }
  }
  return null;
}

/// Calls `use(evaluate)`, where evaluate(SOURCE) gives what the promise of an expression of the page comes to.
async function withPage(use) {
  const program = findChromium();
  if (!program) throw new Error('there is no Chromium on the PATH');
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'lacquer-chromium-'));
  // A page from a file is a secure context, which WebGPU wants.
  const page = path.join(profile, 'page.html');
  fs.writeFileSync(page, '<!doctype html><title>Lacquer</title>');
  const browser = spawn(program, [
    '--headless', '--no-sandbox', '--disable-gpu-watchdog', '--enable-unsafe-webgpu',
    '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan', `--user-data-dir=${profile}`,
    '--remote-debugging-pipe', 'about:blank'
  ], {detached: true, stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});  // a process group of its own
  const waiting = new Map();
  let number = 0;
  let left = '';
  const gone = new Promise((_, reject) => {
    const fail = (error) => {
      for (const {reject: refuse} of waiting.values()) refuse(error);
      reject(error);
    };
    browser.on('error', fail);
    browser.on('exit', () => fail(new Error('Chromium has ended')));
  });
  gone.catch(() => {});
  browser.stdio[4].setEncoding('utf8');
  browser.stdio[4].on('data', (text) => {
    left += text;
    for (let end; (end = left.indexOf('\0')) >= 0;) {
      const message = JSON.parse(left.slice(0, end));
      left = left.slice(end + 1);
      const {resolve, reject} = waiting.get(message.id) ?? {};
      waiting.delete(message.id);
      if (resolve) message.error ? reject(new Error(message.error.message)) : resolve(message.result);
    }
  });
  const send = (method, params = {}, sessionId = undefined) => new Promise((resolve, reject) => {
    waiting.set(++number, {resolve, reject});
    browser.stdio[3].write(`${JSON.stringify({id: number, method, params, sessionId})}\0`);
  });
  try {
    const {targetId} = await send('Target.createTarget', {url: `file://${page}`});
    const {sessionId} = await send('Target.attachToTarget', {targetId, flatten: true});
    const evaluate = async (expression) => {
      const {result, exceptionDetails} =
        await send('Runtime.evaluate', {expression, awaitPromise: true, returnByValue: true}, sessionId);
      if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
      return result.value;
    };
    // The page may still be the empty one.
    while (await evaluate('document.title') !== 'Lacquer') await new Promise((wake) => setTimeout(wake, 50));
    return await Promise.race([use(evaluate), gone]);
  } finally {
    browser.removeAllListeners('exit');
    const ended = new Promise((resolve) => browser.once('exit', resolve));
    if (browser.exitCode === null && browser.pid !== undefined) {
      try {
        process.kill(-browser.pid, 'SIGKILL');  // and all processes that it has started
      } catch {
        browser.kill('SIGKILL');
      }
      await ended;
    }
    try {
      fs.rmSync(profile, {recursive: true, force: true, maxRetries: 10, retryDelay: 20});
    } catch (error) {
      console.error(`${profile} is left behind: ${error.message}`);  // of no meaning for what was asked
    }
  }
}

module.exports = {findChromium, withPage};
