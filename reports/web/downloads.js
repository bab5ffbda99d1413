// Files that the page makes by itself and hands to the reader.

// A name that every file system takes.
function fileName(parts, ending) {
  const plain = parts.filter(Boolean).join(' ').replace(/[^\w.-]+/g, '_').replace(/^[_.]+|_+$/g, '');
  return `${plain.slice(0, 120) || 'simbench'}.${ending}`;
}

function saveFile(name, blob) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  // The download has begun by then; until it has, the address must stay.
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}
